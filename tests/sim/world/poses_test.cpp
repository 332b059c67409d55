#include <catch2/catch.hpp>
#include <filesystem>

#include "interfaces/recording/csv.hpp"
#include "sim/control/pose_plan.hpp"
#include "tests/sim/rigs.hpp"
#include "tests/sim/world/limb.hpp"
#include "tests/sim/world/readings.hpp"

namespace {

/// Line lengths of a plan at some time, between its rows.
std::vector<double> lines_at(const recording::Table& plan, std::size_t actuators, double time_s) {
  const auto& times = plan.find("time_s")->values;
  std::size_t row = 0;
  while (row + 2 < times.size() && times[row + 1] <= time_s) ++row;
  const double fraction =
      std::clamp((time_s - times[row]) / (times[row + 1] - times[row]), 0.0, 1.0);
  std::vector<double> lines(actuators);
  for (std::size_t k = 0; k < actuators; ++k) {
    const auto& line = plan.columns[2 + 2 * k].values;
    lines[k] = line[row] + fraction * (line[row + 1] - line[row]);
  }
  return lines;
}

/// Distance of the joints from a pose; free bodies are not planned.
double distance_rad(const Limb& limb, const sim::Pose& pose) {
  double largest_rad = 0;
  for (std::size_t j = 0; j < pose.size(); ++j) {
    const sim::JointReading& now = limb.world.joints()[j];
    if (now.type == erp::JointType::free) continue;
    sim::JointReading desired = now;
    desired.position = pose[j];
    largest_rad = std::max(largest_rad, angle_between_rad(now, desired));
  }
  return largest_rad;
}

}  // namespace

TEST_CASE("every torso reaches its poses under length control and returns") {
  const auto* name = GENERATE("ecce1", "ecce2", "ecce3", "ecce4");
  CAPTURE(name);
  const std::string folder = rigs::config(name);
  const erp::Robot robot = erp::read_robot(folder + "/robot.xml");
  const auto plan = recording::read_table(folder + "/lengths.csv");
  const auto poses = sim::poses_of(recording::read_table(folder + "/poses.csv"), robot);
  Limb limb(robot);
  double time_s = 0, largest_error_rad = 0;
  for (std::size_t p = 1; p < poses.size(); ++p) {
    for (; time_s < poses[p].time_s - 1e-9; time_s += 0.002)
      limb.follow_lines(lines_at(plan, robot.actuators.size(), time_s));
    if (poses[p].pose != poses[p - 1].pose) continue;
    largest_error_rad = std::max(largest_error_rad, distance_rad(limb, poses[p].pose));
    CAPTURE(poses[p].time_s);
    REQUIRE(largest_error_rad < 0.1);
  }
  WARN(robot.name << ": at most " << largest_error_rad << " rad from a pose that it holds");
  CHECK(limb.all_running());
}
