#include <bit>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <numeric>

#include "sim/formats/formats.hpp"
#include "sim/world/world.hpp"
#include "tests/bench/accuracy/figure.hpp"
#include "tests/sim/formats/file.hpp"
#include "tests/sim/rigs.hpp"

namespace accuracy {
namespace {

using sim::World;

/// Elbow angle of the hinge rig after 0.2 s at 2 V and −1 V.
double elbow_rad(double dt_s) {
  World world(erp::read_robot(rigs::config("hinge_rig/robot.xml")), {.usual_step_s = dt_s});
  for (int k = 0; k < std::lround(0.2 / dt_s); ++k) world.step(std::vector{2.0, -1.0}, dt_s);
  return world.joints()[0].position[0];
}

// error ~ dt^p:  p = log₂ (error(2 dt) / error(dt))
double order() {
  const double exact_rad = elbow_rad(1e-3 / 32);
  return std::log2(std::abs(elbow_rad(1e-3) - exact_rad) / std::abs(elbow_rad(5e-4) - exact_rad));
}

void append_values(const World& world, std::vector<double>& values) {
  for (const auto& joint : world.joints()) {
    values.insert(values.end(), joint.position.begin(), joint.position.end());
    values.insert(values.end(), joint.velocity_rad_per_s.begin(), joint.velocity_rad_per_s.end());
  }
  for (const auto& a : world.actuators())
    for (const double value :
         {a.tension_N, a.length_m, a.current_A, a.speed_rad_per_s, a.shaft_rad, a.line_m})
      values.push_back(value);
}

/// Runs steps of 1 ms with voltages oscillating by ±2 V, chosen. Returns all values after each
/// step.
std::vector<double> drive(World& world, int from, int to) {
  std::vector<double> voltage_V(world.actuators().size()), values;
  for (int i = from; i < to; ++i) {
    for (std::size_t k = 0; k < voltage_V.size(); ++k)
      voltage_V[k] = 2 * std::sin(0.01 * i + static_cast<double>(k));
    world.step(voltage_V, 1e-3);
    append_values(world, values);
  }
  return values;
}

/// Counts values that are not equal bit by bit.
double count_different(const std::vector<double>& a, const std::vector<double>& b) {
  const auto differ = [](double x, double y) {
    return std::bit_cast<std::uint64_t>(x) != std::bit_cast<std::uint64_t>(y);
  };
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0, std::plus(), differ);
}

double values_different_in_reruns(const erp::Robot& robot) {
  World world(robot), second_world(robot);
  const auto first = drive(world, 0, 2000), second = drive(second_world, 0, 2000);
  world.reset();
  return count_different(first, second) + count_different(first, drive(world, 0, 2000));
}

double values_different_after_restore(const erp::Robot& robot) {
  World original(robot), second_world(robot);
  drive(original, 0, 700);
  drive(second_world, 300, 350);  // a different state
  second_world.restore(original.save());
  return count_different(drive(original, 700, 1200), drive(second_world, 700, 1200));
}

double robots_changed_by_collada() {
  double different_robots = 0;
  for (const auto& folder : std::filesystem::directory_iterator(rigs::config(""))) {
    const auto path = folder.path() / "robot.xml";
    if (!std::filesystem::exists(path)) continue;
    const erp::Robot robot = erp::read_robot(path);
    const File collada(formats::to_collada(robot), ".dae");
    different_robots +=
        erp::write_robot(formats::from_collada(collada.path)) != erp::write_robot(robot);
  }
  return different_robots;
}

}  // namespace

Figures order_and_repetition() {
  const erp::Robot arm = erp::read_robot(rigs::config("arm/robot.xml"));
  return {{9, "order of convergence in dt of the hinge rig's elbow angle, minus 1",
           std::abs(order() - 1), 0.25, ""},
          {9, "values that differ in a second run of the arm, in a new world and after a reset",
           values_different_in_reruns(arm), 0, "values"},
          {9, "values that differ in 500 steps after save and restore",
           values_different_after_restore(arm), 0, "values"},
          {9, "robots that differ after export to and import from COLLADA",
           robots_changed_by_collada(), 0, "robots"}};
}

}  // namespace accuracy
