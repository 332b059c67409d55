#include "sim/world/homing_estimate.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "sim/world/simulated_robot.hpp"

using namespace sim;

namespace {

erp::Robot robot_named(const std::string& name) {
  return erp::read_robot(ERP_SOURCE_DIR "/configs/" + name + "/robot.xml");
}

HomingSnapshot snapshot_of(const SimulatedRobot& robot, const erp::Robot& model) {
  HomingSnapshot snapshot;
  for (std::size_t a = 0; a < model.actuators.size(); ++a) {
    const auto& sample = robot.sample_of(a);
    const auto& units = robot.units(a);
    snapshot.line_m.push_back(units.line_m(units.shaft_rad(sample.encoder_counts)));
    snapshot.tension_N.push_back(units.tension_N(sample.tension_counts));
  }
  for (std::size_t s = 0; s < model.joint_sensors.size(); ++s)
    snapshot.joint_rad.push_back(robot.frame().analogs._buffer[s].counts * 2 * M_PI /
                                 std::exp2(model.joint_sensors[s].bits_per_rev));
  return snapshot;
}

/// Tensions of 3 or 12 N in patterns that differ between the actuators.
std::vector<std::vector<double>> patterns(std::size_t actuators, int count) {
  std::vector<std::vector<double>> sets;
  for (int k = 0; k < count; ++k) {
    auto& set = sets.emplace_back();
    for (std::size_t a = 0; a < actuators; ++a)
      set.push_back((a * 2654435761U >> (7 + k)) & 1 ? 12 : 3);
  }
  return sets;
}

void hold(SimulatedRobot& robot, const std::vector<double>& from_N, const std::vector<double>& to_N,
          double seconds) {
  for (double t = 0; t < seconds; t += 0.002) {
    std::vector<SetPoint> points;
    for (std::size_t a = 0; a < to_N.size(); ++a)
      points.push_back(
          {erp::Mode::force, from_N[a] + std::min(1.0, t / 2) * (to_N[a] - from_N[a])});
    robot.tick(points);
  }
}

/// Errors of the lines, in m. The robot first leaves its starting pose.
struct Homed {
  std::vector<double> error_m, sigma_m;
};

Homed home(const std::string& name, const std::vector<std::vector<double>>& sets,
           const std::vector<std::string>& unknown) {
  const erp::Robot model = robot_named(name);
  SimulatedRobot robot(model, 7);
  std::vector<double> last_N(model.actuators.size(), 8.0);
  hold(robot, last_N, last_N, 4);
  HomingEstimate estimate(model);
  std::vector<HomingSnapshot> snapshots;
  for (const auto& set : sets) {
    hold(robot, last_N, set, 4);
    last_N = set;
    snapshots.push_back(snapshot_of(robot, model));
  }
  std::vector<bool> known;
  for (std::size_t a = 0; a < model.actuators.size(); ++a) {
    known.push_back(!unknown.empty() &&
                    std::ranges::find(unknown, model.actuators[a].name) == unknown.end());
    if (known[a]) continue;
    for (auto& snapshot : snapshots) snapshot.line_m[a] += 0.01 * static_cast<double>(1 + a % 5);
  }
  const auto lines = estimate.find(snapshots, known, estimate.simulate(sets, 2, 4));
  Homed homed;
  for (std::size_t a = 0; a < known.size(); ++a) {
    const double wrong_m = known[a] ? 0 : 0.01 * static_cast<double>(1 + a % 5);
    homed.error_m.push_back(lines.offset_m[a] + wrong_m);
    homed.sigma_m.push_back(lines.sigma_m[a]);
  }
  return homed;
}

}  // namespace

TEST_CASE("one snapshot of a robot with a sensor on every joint gives all lines") {
  const auto homed = home("leg", {std::vector<double>(6, 5.0)}, {});
  for (std::size_t a = 0; a < homed.error_m.size(); ++a) {
    CHECK(std::abs(homed.error_m[a]) < 0.0001);
    CHECK(homed.sigma_m[a] < 0.0005);
  }
}

TEST_CASE("one snapshot gives two unknown lines if the others are known") {
  const auto homed = home("arm", {std::vector<double>(11, 5.0)}, {"pectoralis", "biceps"});
  for (std::size_t a = 0; a < homed.error_m.size(); ++a) CHECK(std::abs(homed.error_m[a]) < 0.0005);
}

TEST_CASE(
    "without a sensor in the shoulder, one snapshot says that it does not determine the lines") {
  const auto homed = home("arm", {std::vector<double>(11, 5.0)}, {});
  CHECK(*std::ranges::max_element(homed.sigma_m) > 0.005);
}

TEST_CASE("six snapshots in different poses give the lines of the arm") {
  const auto homed = home("arm", patterns(11, 6), {});
  for (std::size_t a = 0; a < homed.error_m.size(); ++a) {
    CAPTURE(a, homed.error_m[a]);
    CHECK(std::abs(homed.error_m[a]) < 0.0005);
    CHECK(std::abs(homed.error_m[a]) < 3 * homed.sigma_m[a]);
    CHECK(homed.sigma_m[a] < 0.0025);
  }
}
