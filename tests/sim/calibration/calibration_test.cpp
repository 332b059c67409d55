#include <catch2/catch.hpp>
#include <filesystem>
#include <random>

#include "interfaces/recording/csv.hpp"
#include "interfaces/xml/xml.hpp"
#include "sim/actuator/holding.hpp"
#include "sim/calibration/evolution_learner.hpp"
#include "tests/sim/rigs.hpp"

using namespace sim::calibration;

namespace {

const char* const all_of_it =
    "<calibration><vary what=\"attachments\" spread=\"0.005\"/><vary what=\"length\" "
    "spread=\"0.005\"/><vary what=\"stiffness\" spread=\"0.2\"/><vary what=\"radius\" "
    "spread=\"0.05\"/></calibration>";

erp::Robot arm() { return erp::read_robot(rigs::config("arm/robot.xml")); }

/// Poses that the robot holds, as statics has them.
std::vector<StillPose> held_poses(const erp::Robot& robot, int count) {
  std::vector<StillPose> poses;
  sim::PoseHolder holder(robot);
  for (int k = 0; k < count; ++k) {
    const double turn = 0.25 * std::sin(1.7 * k), elbow = 0.8 + 0.4 * std::cos(2.3 * k);
    StillPose still{double(k), {}, {{std::cos(turn), std::sin(turn), 0, 0}, {elbow}}};
    const auto holding = holder.hold(still.pose);
    for (std::size_t a = 0; a < robot.actuators.size(); ++a)
      still.shaft_rad.push_back(-holding.line_m[a] / robot.actuators[a].spindle.radius_m);
    poses.push_back(still);
  }
  return poses;
}

EvolutionLearner learner(std::uint64_t seed = 1) {
  Parameters parameters(arm(), xml::parse<Choice>(all_of_it, "choice"));
  Eigen::VectorXd off(parameters.size());
  std::mt19937 dice(5);
  std::normal_distribution<double> normal;
  for (double& x : off) x = normal(dice);
  const Candidate real{parameters.robot_at(off)};
  erp::Robot whole = real.robot;
  whole.effects.clear();
  return EvolutionLearner(std::move(parameters), split(held_poses(whole, 8)), {.seed = seed});
}

std::string folder(const std::string& name) {
  const auto path = std::filesystem::temp_directory_path() / ("erp_calibration_" + name);
  std::filesystem::remove_all(path);
  return path.string();
}

}  // namespace

TEST_CASE("nine numbers a muscle, and at zero the robot is as it was") {
  const Parameters parameters(arm(), xml::parse<Choice>(all_of_it, "choice"));
  CHECK(parameters.size() == 99);
  CHECK(erp::write_robot(parameters.robot_at(Eigen::VectorXd::Zero(99))) ==
        erp::write_robot(arm()));
  CHECK_THROWS_WITH(
      Parameters(arm(), xml::parse<Choice>("<calibration><vary what=\"length\" spread=\"1\" "
                                           "on=\"bicep\"/></calibration>",
                                           "choice")),
      Catch::Contains("no actuator \"bicep\""));
}

TEST_CASE("the robot itself makes no error in its own poses") {
  const auto poses = held_poses(arm(), 6);
  const Candidate itself{arm(), {}};
  CHECK(pose_errors(itself, poses).mean_of_all_rad < 1e-5);
}

TEST_CASE("a calibration comes nearer, the same on one thread and two, killed and resumed") {
  auto one = learner(), two = learner(), resumed = learner();
  const double before = one.metrics()[0].value;
  sim::learner::learn(one, {.folder = folder("one"), .rounds = 6});
  sim::learner::learn(two, {.folder = folder("two"), .rounds = 6, .threads = 2});
  CHECK(one.best() == two.best());
  CHECK(one.metrics()[0].value < before);
  const auto there = folder("resumed");
  sim::learner::learn(resumed, {.folder = there, .rounds = 6, .told = [](const auto& l) {
                                  return l.rounds() < 3;
                                }});
  auto after = learner();
  CHECK_THROWS_WITH(sim::learner::learn(after, {.folder = there, .rounds = 6}),
                    Catch::Contains("resume it"));
  sim::learner::learn(after, {.folder = there, .rounds = 6, .resume = true});
  CHECK(after.best() == one.best());
  auto other = learner(2);
  CHECK_THROWS_WITH(sim::learner::learn(other, {.folder = there, .rounds = 6, .resume = true}),
                    Catch::Contains("another seed"));
  for (const char* name : {"one", "two", "resumed"}) folder(name);
}

TEST_CASE("still poses of a recording are where nothing moved, each once, its mean") {
  const erp::Robot robot = erp::read_robot(rigs::config("hinge_rig/robot.xml"));
  recording::Table table{{{"time_s", {}},
                          {"flexor.shaft_rad", {}},
                          {"extensor.shaft_rad", {}},
                          {"elbow.angle_rad", {}}}};
  for (int k = 0; k < 400; ++k) {
    const double t = 0.01 * k, wave = k % 2 ? 0.001 : -0.001;
    const double angle = t < 1 ? 0.1 : t < 2 ? 0.1 + 0.5 * (t - 1) : 0.6;
    table.columns[0].values.push_back(t), table.columns[1].values.push_back(10 * angle);
    table.columns[2].values.push_back(-10 * angle);
    table.columns[3].values.push_back(angle + wave);
  }
  const auto poses = still_poses(table, robot);
  REQUIRE(poses.size() == 2);
  CHECK(poses[0].pose[0][0] == Approx(0.1).margin(2e-4));
  CHECK(poses[1].pose[0][0] == Approx(0.6).margin(2e-3));
  CHECK(poses[1].shaft_rad[1] == Approx(-6).margin(0.02));
  table.columns[3].name = "knee.angle_rad";
  CHECK_THROWS_WITH(still_poses(table, robot), Catch::Contains("elbow.angle_rad"));
}
