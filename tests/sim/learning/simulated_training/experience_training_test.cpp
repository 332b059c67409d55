#include "sim/learning/simulated_training/experience_training.hpp"

#include "interfaces/xml/xml.hpp"
#include "tests/sim/learning/simulated_training/training_runs.hpp"
#include "tests/sim/rigs.hpp"

using namespace sim::simulated_training;
namespace experience = sim::experience;

namespace {

/// The robot with seven hinges, a short training.
ExperienceTraining experience_training() {
  const erp::Robot robot = erp::read_robot(rigs::config("seven_dof/robot.xml"));
  auto task = xml::read<experience::Task>(rigs::config("seven_dof/acquisition.xml"));
  task.rounds = 8, task.batch = 24;
  return {robot, task, {sim::starting_pose(robot)}};
}

}  // namespace

TEST_CASE(
    "on seven hinges offsets fall to a tenth in 8 rounds, and below 1 mm with linear feedback") {
  const auto trained = training_runs::run_in_three_ways("experience", experience_training);
  CHECK(trained.rounds() == 8);
  CHECK(trained.tripped() == 0);
  CHECK(trained.base().all().size() == 8 * 24);
  for (const auto& metric : trained.metrics())
    CHECK(metric.value < 15);  // a tenth of the initial offset

  const erp::Robot robot = erp::read_robot(rigs::config("seven_dof/robot.xml"));
  const auto task = xml::read<experience::Task>(rigs::config("seven_dof/acquisition.xml"));
  for (std::size_t k = 0; k < 3; ++k) {
    const sim::Vec3 target = trained.fresh_target(77, k);
    auto reach =
        trained.reach(0, target, experience::linear_feedback(trained.base(), 0, target, 1.5));
    HandTrack track;
    REQUIRE(play(reach, robot, task.hand, task.noise_m, k, &track));
    CHECK((reach.settled_m().value() - target).cwiseAbs().maxCoeff() < 0.03);
    CHECK((track.hand_m.back() - target).cwiseAbs().maxCoeff() < 0.001);
  }
}

TEST_CASE("a checkpoint with another seed is rejected") {
  auto trained = experience_training();
  auto state = trained.state();
  state.replace(state.find("seed=\"1\""), 8, "seed=\"2\"");
  CHECK_THROWS_WITH(trained.restore(state, "state.xml"), Catch::Contains("another seed"));
}
