#include "sim/world/internal_model.hpp"

#include <catch2/catch.hpp>

#include "tests/sim/rigs.hpp"

namespace {

std::vector<std::vector<double>> candidates_for(const erp::Robot& robot, int count) {
  std::vector<std::vector<double>> candidates;
  for (int k = 0; k < count; ++k) candidates.emplace_back(robot.actuators.size(), 0.1 + 0.05 * k);
  return candidates;
}

bool same(const sim::WorldState& a, const sim::WorldState& b) {
  bool equal = a.time_s == b.time_s && a.tension_N == b.tension_N;
  for (std::size_t j = 0; j < a.joints.size(); ++j)
    equal = equal && a.joints[j].position == b.joints[j].position &&
            a.joints[j].velocity_rad_per_s == b.joints[j].velocity_rad_per_s;
  for (std::size_t k = 0; k < a.motors.size(); ++k)
    equal = equal && a.motors[k].current_A == b.motors[k].current_A &&
            a.motors[k].shaft_rad == b.motors[k].shaft_rad;
  return equal;
}

}  // namespace

TEST_CASE("the internal model predicts the world exactly, with any number of threads") {
  const erp::Robot robot = erp::read_robot(rigs::config("arm/robot.xml"));
  sim::World world(robot);
  for (int k = 0; k < 50; ++k) world.step(std::vector<double>(robot.actuators.size(), 0.3), 0.001);
  const sim::WorldState initial = world.save();
  const auto candidates = candidates_for(robot, 7);
  for (const int threads : {1, 2, 5}) {
    sim::InternalModel model(robot, {}, threads);
    REQUIRE(model.threads() == threads);
    for (int round = 0; round < 3; ++round) {  // the worlds are used again
      const auto ends = model.ahead(initial, candidates, 40, 0.001);
      for (std::size_t c = 0; c < candidates.size(); ++c) {
        world.restore(initial);
        for (int k = 0; k < 40; ++k) world.step(candidates[c], 0.001);
        REQUIRE(same(world.save(), ends[c]));
      }
    }
  }
}

TEST_CASE("an exception in one candidate reaches the caller, and the model remains usable") {
  const erp::Robot robot = erp::read_robot(rigs::config("hinge_rig/robot.xml"));
  sim::InternalModel model(robot, {}, 2);
  const sim::WorldState start = sim::World(robot).save();
  CHECK_THROWS_AS(model.ahead(start, std::vector<std::vector<double>>{{0.1}}, 1, 0.001),
                  std::invalid_argument);
  CHECK(model.ahead(start, candidates_for(robot, 3), 5, 0.001).size() == 3);
  CHECK(model.ahead(start, {}, 5, 0.001).empty());
}
