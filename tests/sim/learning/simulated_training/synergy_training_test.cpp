#include "sim/learning/simulated_training/synergy_training.hpp"

#include <cmath>

#include "interfaces/xml/xml.hpp"
#include "tests/sim/learning/simulated_training/training_runs.hpp"
#include "tests/sim/rigs.hpp"

using namespace sim::simulated_training;

namespace {

/// The arm strikes a bottle near its hand, from three rough plans.
SynergyTraining synergy_training() {
  const erp::Robot robot = erp::read_robot(rigs::config("arm/robot.xml"));
  sim::synergy::Task task;
  task.rounds = 12, task.batch = 16, task.times = {0.5, 1, 0.5};
  task.hand = {.place = {}, .body = "forearm", .at_m = {0, 0, -0.3}};
  task.zone = {.place = {}, .from_m = {0.18, -0.26, -0.5}, .to_m = {0.3, -0.14, -0.4}};
  task.bottle.height_m = 0.045,
  task.bottle.radius_m = task.bottle.hand_m = 0.0225;  // hard to strike
  for (const erp::Actuator& a : robot.actuators) task.muscles.all.push_back({{}, a.name});
  std::vector<sim::Pose> poses;
  for (const double elbow_rad : {0.7, 1.1, 1.5})
    for (auto& joint : poses.emplace_back(sim::starting_pose(robot)))
      if (&joint == &poses.back().back()) joint[0] = elbow_rad;
  return {robot, task, poses};
}

}  // namespace

TEST_CASE("from three rough plans an arm learns to strike targets of a zone") {
  const auto trained = training_runs::run_in_three_ways("synergy", synergy_training);
  const auto metrics = trained.metrics();
  REQUIRE(metrics.at(1).name == "returned_percent");
  CHECK(metrics.at(1).value == 100);
  CHECK(trained.bank().plans().size() > 20);
  const auto untrained = synergy_training();
  CHECK(untrained.bank().plans().size() == 3);
  double before_m = 0, after_m = 0;
  for (std::size_t k = 0; k < 12; ++k) {
    before_m += untrained.test(untrained.bank(), 5, k).outcome.nearest_m / 12;
    const auto test = trained.test(trained.bank(), 5, k);
    after_m += test.outcome.nearest_m / 12;
    CHECK(test.relative_jerk > 1);
    CHECK(test.returned);
  }
  CHECK(after_m < 0);                 // overlap: struck
  CHECK(after_m < before_m - 0.001);  // the initial blends already come close
}

TEST_CASE("a checkpoint with other muscles is rejected") {
  auto trained = synergy_training();
  auto saved = xml::parse<sim::synergy::BankFile>(trained.state(), "state.xml");
  saved.muscles.all.pop_back();
  for (auto& plan : saved.plans.all) plan.weights_m.pop_back();
  CHECK_THROWS_WITH(trained.restore(xml::write(saved), "state.xml"),
                    Catch::Contains("other muscles"));
}
