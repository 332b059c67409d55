// arm_poses csv ROBOT.xml          the fifteen poses as a reference trajectory
// (configs/arm/poses.csv) arm_poses pretension ROBOT.xml   the pretensions that balance the
// starting pose arm_poses tensions ROBOT.xml     the tension of each muscle in each pose
#include <cstdio>
#include <cstring>
#include <exception>

#include "sim/world/arm_poses.hpp"

namespace {

constexpr double ramp_s = 1.5, hold_s = 1.5, sample_s = 0.05;

/// Least jerk: 10 s³ − 15 s⁴ + 6 s⁵ (Flash and Hogan 1985).
double least_jerk(double s) { return s >= 1 ? 1 : s * s * s * (10 + s * (6 * s - 15)); }

void row(double time_s, const std::vector<double>& from, const std::vector<double>& to, double s) {
  std::printf("%.2f", time_s);
  for (std::size_t k = 0; k < to.size(); ++k)
    std::printf(",length,%.7f", from[k] + least_jerk(s) * (to[k] - from[k]));
  std::printf("\n");
}

void write_csv(const erp::Robot& robot) {
  std::printf("time_s");
  for (const auto& a : robot.actuators)
    std::printf(",%s.mode,%s.reference", a.name.c_str(), a.name.c_str());
  std::printf("\n");
  std::vector<double> from(robot.actuators.size(), 0.0);
  double start_s = 0;
  for (const sim::Pose& pose : sim::arm_poses()) {
    const std::vector<double> to = sim::hold_pose(robot, pose).line_m;
    for (int k = 0; k * sample_s < ramp_s; ++k)
      row(start_s + k * sample_s, from, to, k * sample_s / ramp_s);
    row(start_s + ramp_s, from, to, 1);
    start_s += ramp_s + hold_s;
    from = to;
  }
  row(start_s, from, from, 1);
}

void write_tensions(const erp::Robot& robot, const std::vector<sim::Pose>& poses,
                    const sim::HoldingOptions& options) {
  for (std::size_t k = 0; k < robot.actuators.size(); ++k) {
    std::printf("%-18s", robot.actuators[k].name.c_str());
    for (const sim::Pose& pose : poses)
      std::printf(" %6.1f", sim::hold_pose(robot, pose, options).tension_N[k]);
    std::printf("\n");
  }
  std::printf("%-18s", "unbalanced_Nm");
  for (const sim::Pose& pose : poses)
    std::printf(" %6.3f", sim::hold_pose(robot, pose, options).unbalanced_Nm);
  std::printf("\n");
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc == 3) {
    const erp::Robot robot = erp::read_robot(argv[2]);
    if (!std::strcmp(argv[1], "csv")) return write_csv(robot), 0;
    if (!std::strcmp(argv[1], "tensions")) return write_tensions(robot, sim::arm_poses(), {}), 0;
    if (!std::strcmp(argv[1], "pretension"))
      return write_tensions(robot, {sim::starting_pose(robot)}, {.rest_N = 10, .least_N = 5}), 0;
  }
  std::fprintf(stderr, "usage: arm_poses csv|pretension|tensions ROBOT.xml\n");
  return 2;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
