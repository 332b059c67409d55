#include <catch2/catch.hpp>
#include <cmath>
#include <vector>

#include "tests/sim/model/effects/magnitudes.hpp"
#include "tests/sim/rigs.hpp"
#include "tests/sim/world/limb.hpp"

namespace effects = sim::effects;

namespace {

using Counts = std::vector<std::int64_t>;

using rigs::hinge_rig;

erp::Robot with_effect(const effects::AnyEffect& effect) {
  erp::Robot robot = hinge_rig();
  robot.effects = {effects::written({magnitudes::place_in_rig(effect), effect})};
  return robot;
}

/// The ECU readings of the rig over 6 s of changing tensions and of a line unwound until slack.
Counts recording(const erp::Robot& robot) {
  Limb limb(robot);
  erp::EcuFrame frame;
  Counts counts;
  for (int k = 0; k < 3000; ++k) {
    const double t = 0.002 * k, swing = 45 * std::sin(3 * t) + 8 * std::sin(17 * t);
    const double co_contraction = k % 500 < 60 ? 0 : 12;
    if (k % 500 < 150) limb.command(ECU_REQUEST_VOLTAGE, {k % 500 < 100 ? -9000.0 : 6000.0, 0});
    else
      limb.command(ECU_REQUEST_FORCE, {1000 * std::fmax(0.0, co_contraction + swing + 10),
                                       1000 * std::fmax(0.0, co_contraction - swing)});
    limb.ecus.tick(limb.world);
    limb.ecus.fill(frame);
    for (const auto& c : erp::samples(frame.channels))
      for (const std::int64_t reading :
           {std::int64_t(c.encoder_counts), std::int64_t(c.duty_counts),
            std::int64_t(c.current_counts), std::int64_t(c.tension_counts)})
        counts.push_back(reading);
    for (const auto& a : erp::samples(frame.analogs)) counts.push_back(a.counts);
  }
  CHECK(limb.world.is_finite());
  return counts;
}

double fraction_changed(const Counts& a, const Counts& b) {
  std::size_t changed = 0;
  for (std::size_t k = 0; k < a.size(); ++k) changed += a[k] != b[k];
  return static_cast<double>(changed) / static_cast<double>(a.size());
}

}  // namespace

TEST_CASE(
    "every effect changes the rig's sensor readings, and with default parameters it changes no "
    "bit") {
  const Counts unchanged = recording(hinge_rig());
  for (const auto& neutral : effects::library()) {
    const std::string type(effects::about(neutral).type);
    INFO(type);
    CHECK(recording(with_effect(neutral)) == unchanged);
    CHECK(fraction_changed(recording(with_effect(magnitudes::visible(type))), unchanged) > 0.05);
  }
}

TEST_CASE("a world with effects continues from a saved state bit by bit") {
  erp::Robot robot = hinge_rig();
  for (const char* type : {"gearbox_backlash", "spindle_slip", "tendon_creep", "tendon_hysteresis",
                           "motor_thermal_resistance", "joint_stribeck"}) {
    const auto effect = magnitudes::visible(type);
    robot.effects.push_back(effects::written({magnitudes::place_in_rig(effect), effect}));
  }
  sim::World original(robot), other(robot);
  const auto drive = [](sim::World& world, int steps) {
    for (int k = 0; k < steps; ++k) {
      const double v = 4 * std::sin(20 * world.time_s());
      world.step(std::vector<double>{v, -v}, 0.001);
    }
  };
  drive(original, 700);
  other.restore(original.save());
  drive(original, 700), drive(other, 700);
  for (int k = 0; k < 2; ++k) {
    CHECK(original.actuators()[k].tension_N == other.actuators()[k].tension_N);
    CHECK(original.actuators()[k].shaft_rad == other.actuators()[k].shaft_rad);
  }
  CHECK(original.joints()[0].position[0] == other.joints()[0].position[0]);
}

TEST_CASE("effects on a tendon modelled as a rope are rejected") {
  erp::Robot robot = with_effect(magnitudes::visible("tendon_creep"));
  robot.actuators[0].rope = erp::Rope{{}, 20, 0.01, 0.0005, 0, ""};
  CHECK_THROWS_WITH(sim::World(robot), Catch::Contains("is a rope"));
}
