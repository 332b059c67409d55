#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <random>

#include "interfaces/recording/csv.hpp"
#include "interfaces/xml/xml.hpp"
#include "sim/learning/calibration/perturb.hpp"
#include "sim/learning/calibration/sensitivity.hpp"
#include "sim/learning/calibration/strategy.hpp"
#include "sim/model/effects/library.hpp"
#include "tests/sim/learning/calibration/arm_poses.hpp"

using namespace sim::calibration;
using arm_poses::arm, arm_poses::held_poses;

namespace {

const char* const all_parameters =
    "<calibration><vary what=\"attachments\" spread=\"0.005\"/><vary what=\"length\" "
    "spread=\"0.005\"/><vary what=\"stiffness\" spread=\"0.2\"/><vary what=\"radius\" "
    "spread=\"0.05\"/></calibration>";

/// An arm that differs from robot.xml, in eight poses.
Task task() {
  Parameters parameters(arm(), xml::parse<Choice>(all_parameters, "choice"));
  Eigen::VectorXd offset(parameters.size());
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (double& x : offset) x = normal(random);
  erp::Robot perturbed_robot = parameters.robot_at(offset);
  perturbed_robot.effects.clear();
  return {std::move(parameters), split(held_poses(perturbed_robot, 8))};
}

std::unique_ptr<Calibration> calibration_by(Strategy strategy, std::uint64_t seed = 1) {
  return make_calibration(task(), {.strategy = strategy, .seed = seed});
}

std::string folder_of(const std::string& name) {
  return (std::filesystem::temp_directory_path() / ("erp_calibration_" + name)).string();
}
/// The folder, emptied.
std::string folder(const std::string& name) {
  std::filesystem::remove_all(folder_of(name));
  return folder_of(name);
}

std::string text_of(const std::string& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator(in), {}};
}

}  // namespace

TEST_CASE("there are nine parameters per muscle, and zero gives the original robot") {
  const Parameters parameters(arm(), xml::parse<Choice>(all_parameters, "choice"));
  CHECK(parameters.size() == 99);
  CHECK(erp::write_robot(parameters.robot_at(Eigen::VectorXd::Zero(99))) ==
        erp::write_robot(arm()));
  CHECK_THROWS_WITH(
      Parameters(arm(), xml::parse<Choice>("<calibration><vary what=\"length\" spread=\"1\" "
                                           "on=\"bicep\"/></calibration>",
                                           "choice")),
      Catch::Contains("no actuator \"bicep\""));
}

TEST_CASE("the parameters of the robot have no error in the robot's poses") {
  const auto poses = held_poses(arm(), 6);
  const Candidate unchanged{arm(), {}};
  CHECK(pose_errors(unchanged, poses).mean_of_all_rad < 1e-5);
}

TEST_CASE(
    "a calibration reduces the error, identically on one thread, on two threads, and when "
    "resumed") {
  const auto strategy = GENERATE(Strategy::evolution, Strategy::cma, Strategy::newton);
  const auto one_thread = calibration_by(strategy), two_threads = calibration_by(strategy),
             interrupted = calibration_by(strategy);
  const double before = one_thread->metrics()[0].value;
  sim::training_loop::run(*one_thread, {.folder = folder("one"), .rounds = 4});
  sim::training_loop::run(*two_threads, {.folder = folder("two"), .rounds = 4}, sim::Threads(2));
  CHECK(one_thread->best() == two_threads->best());
  CHECK(one_thread->metrics()[0].value < before);
  const auto folder_path = folder("killed");
  sim::training_loop::run(*interrupted, {.folder = folder_path,
                                         .rounds = 4,
                                         .on_round = [](const auto& l) { return l.rounds() < 2; }});
  const auto resumed = calibration_by(strategy);
  CHECK_THROWS_WITH(sim::training_loop::run(*resumed, {.folder = folder_path, .rounds = 4}),
                    Catch::Contains("resume it"));
  sim::training_loop::run(*resumed, {.folder = folder_path, .rounds = 4, .resume = true});
  CHECK(resumed->best() == one_thread->best());
  CHECK(text_of(folder_path + "/curve.csv") == text_of(folder_of("one") + "/curve.csv"));
  for (const char* name : {"one", "two", "killed"}) folder(name);
}

TEST_CASE("a checkpoint of another seed or strategy is rejected") {
  const auto folder_path = folder("other");
  sim::training_loop::run(*calibration_by(Strategy::evolution),
                          {.folder = folder_path, .rounds = 1});
  CHECK_THROWS_WITH(sim::training_loop::run(*calibration_by(Strategy::evolution, 2),
                                            {.folder = folder_path, .rounds = 2, .resume = true}),
                    Catch::Contains("another seed"));
  CHECK_THROWS(sim::training_loop::run(*calibration_by(Strategy::newton),
                                       {.folder = folder_path, .rounds = 2, .resume = true}));
  folder("other");
}

TEST_CASE("Gauss-Newton reduces the pose error below 5 %") {
  const auto newton = calibration_by(Strategy::newton);
  const double before = newton->best_error_rad();
  sim::training_loop::run(*newton, {.folder = folder("newton"), .rounds = 20});
  CHECK(newton->done());
  CHECK(newton->best_error_rad() < 0.05 * before);
  folder("newton");
}

TEST_CASE("the derivative of poses by parameters equals the difference quotient") {
  const Task arm_task = task();
  const Eigen::VectorXd x = Eigen::VectorXd::Constant(99, 0.1);
  const Residuals result = turns(arm_task.parameters, x, arm_task.poses.learn, sim::Threads());
  REQUIRE(result.slope.rows() == 16);
  constexpr double step = 1e-3;
  for (Eigen::Index k = 0; k < 99; k += 7) {
    Eigen::VectorXd up = x, down = x;
    up[k] += step, down[k] -= step;
    const Eigen::VectorXd slope = (turns_rad(arm_task.parameters.at(up), arm_task.poses.learn) -
                                   turns_rad(arm_task.parameters.at(down), arm_task.poses.learn)) /
                                  (2 * step);
    INFO(arm_task.parameters.name_of(arm_task.parameters.list()[std::size_t(k)]));
    CHECK((result.slope.col(k) - slope).norm() < 0.1 * slope.norm() + 1e-5);
  }
}

TEST_CASE("a parameter without influence on the poses keeps its prior uncertainty") {
  Eigen::MatrixXd slope = Eigen::MatrixXd::Zero(2, 3);
  slope(0, 0) = 1, slope(1, 1) = 1e-4;
  const auto result = identified(slope, 1e-3);
  CHECK(result.combinations == 1);
  CHECK(result.remaining[0] == Approx(1e-3).epsilon(1e-3));
  CHECK(result.remaining[1] == Approx(1 / std::sqrt(1.01)));
  CHECK(result.remaining[2] == Approx(1));
}

TEST_CASE("a tendon_length_offset of robot.xml is the start of the search") {
  erp::Robot robot = arm();
  robot.effects.push_back(
      sim::effects::written({"biceps", sim::effects::TendonLengthOffset{0.01}}));
  const Parameters parameters(robot,
                              xml::parse<Choice>("<calibration><vary what=\"length\" on=\"biceps\" "
                                                 "spread=\"0.002\"/></calibration>",
                                                 "choice"));
  const Candidate candidate = parameters.at(Eigen::VectorXd::Constant(1, 2));
  CHECK(candidate.length_offset_m[7] == Approx(0.014));
  CHECK(candidate.robot.effects.empty());
  CHECK(parameters.robot_at(Eigen::VectorXd::Zero(1)).effects.size() == 1);
}

TEST_CASE("a perturbed model has the requested error at each joint") {
  const Parameters parameters(arm(), xml::parse<Choice>(all_parameters, "choice"));
  const auto poses = held_poses(arm(), 8);
  const std::array<double, 2> off_rad{0.3, 0.2};
  const auto x = perturbed(parameters, poses, off_rad, 3);
  const auto offset = pose_errors(parameters.at(x), poses);
  CHECK(offset.mean_rad[0] == Approx(0.3).epsilon(0.06));
  CHECK(offset.mean_rad[1] == Approx(0.2).epsilon(0.06));
  CHECK(x != perturbed(parameters, poses, off_rad, 4));
}

TEST_CASE("a candidate with a point inside its pulley has a larger error than any valid one") {
  const Task arm_task = task();
  Eigen::VectorXd x = Eigen::VectorXd::Zero(arm_task.parameters.size());
  const double initial_rad = error_rad(arm_task, x);
  const auto& list = arm_task.parameters.list();
  for (std::size_t k = 0; k < list.size(); ++k)
    if (const auto name = arm_task.parameters.name_of(list[k]);
        name == "triceps_long B x" || name == "triceps_long B z")
      x[static_cast<Eigen::Index>(k)] =
          0.018 / list[k].spread;  // moves its end into the elbow's pulley
  CHECK(error_rad(arm_task, x) > 1e3 * initial_rad);
}

TEST_CASE("two poses at rest in a recording are found, each as the mean of its rows") {
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
