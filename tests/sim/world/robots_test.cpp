#include <catch2/catch.hpp>
#include <filesystem>

#include "tests/sim/rigs.hpp"
#include "tests/sim/world/limb.hpp"
#include "tests/sim/world/readings.hpp"

namespace {

std::vector<std::string> robot_files() {
  std::vector<std::string> files;
  for (const auto& folder : std::filesystem::directory_iterator(rigs::config("")))
    if (const auto file = folder.path() / "robot.xml"; std::filesystem::exists(file))
      files.push_back(file);
  std::ranges::sort(files);
  return files;
}

}  // namespace

/// Friction, which could hold any pose, is removed. Only the muscles then hold the pose.
TEST_CASE("every robot holds its pose for a minute under length control, without drift") {
  for (const std::string& file : robot_files()) {
    CAPTURE(file);
    erp::Robot robot = erp::read_robot(file);
    for (auto& part : robot.skeletons)
      for (auto& joint : part.joints) joint.coulomb_Nm = 0;
    Limb limb(robot);
    const std::vector<double> lines(robot.actuators.size(), 0.0);
    const auto largest_motion_rad = [&](double seconds) {
      const std::vector<sim::JointReading> from(limb.world.joints().begin(),
                                                limb.world.joints().end());
      double largest_rad = 0;
      for (int k = 0; k < std::lround(500 * seconds); ++k) {
        limb.follow_lines(lines);
        largest_rad = std::max(largest_rad, angle_between_rad(limb.world.joints(), from));
      }
      return largest_rad;
    };
    const double settling = largest_motion_rad(5), drift = largest_motion_rad(55);
    WARN(robot.name << " settles by " << settling << " rad, then drifts by " << drift << " rad");
    CHECK(limb.all_running());
    CHECK(settling < 0.15);
    CHECK(drift < 0.01);
  }
}
