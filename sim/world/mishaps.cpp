#include "sim/world/mishaps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace sim {

namespace {

bool of_program(MishapKind kind) {
  return kind == MishapKind::hang || kind == MishapKind::busy || kind == MishapKind::bus_off;
}

}  // namespace

bool Mishaps::needs_separate_ecus() const {
  return std::ranges::any_of(list_, [](const Placed& one) { return of_program(one.what.kind); });
}

Mishaps::Mishaps(std::vector<Mishap> list, const erp::Robot& robot) {
  for (Mishap& mishap : list) {
    const auto found = std::ranges::find(robot.actuators, mishap.on, &erp::Actuator::name);
    if (found == robot.actuators.end())
      throw std::invalid_argument("a mishap on \"" + mishap.on +
                                  "\", which the robot does not have");
    const auto k = static_cast<std::size_t>(found - robot.actuators.begin());
    list_.push_back({std::move(mishap), k, found->ecu});
  }
}

void Mishaps::befall(std::size_t k, double time_s, const SensorScale& scale, const ecu_inputs& last,
                     ecu_inputs& inputs) const {
  for (const Placed& one : list_) {
    if (one.actuator != k || !is_on(one.what, time_s)) continue;
    const auto counts = static_cast<std::uint16_t>(one.what.counts);
    switch (one.what.kind) {
      case MishapKind::tension_open:
        inputs.tension_counts = static_cast<std::uint16_t>(scale.tension_counts_max);
        break;
      case MishapKind::tension_short:
        inputs.tension_counts = 0;
        break;
      case MishapKind::tension_stuck:
        inputs.tension_counts = last.tension_counts;
        break;
      case MishapKind::current_stuck:
        inputs.current_counts = last.current_counts;
        break;
      case MishapKind::encoder_lost:
        inputs.encoder_counts = last.encoder_counts;
        break;
      case MishapKind::encoder_slips:
        inputs.encoder_counts += static_cast<std::int32_t>(
            std::lround(std::numbers::pi / 2 / scale.shaft_rad_per_count));
        break;
      case MishapKind::over_current:
        inputs.current_counts = static_cast<std::int16_t>(scale.current_counts_max);
        break;
      case MishapKind::hot:
        inputs.temperature_counts = counts;
        break;
      case MishapKind::supply_low:
        inputs.supply_counts = counts;
        break;
      default:
        break;
    }
  }
}

void Mishaps::befall(World& world) const {
  for (const Placed& one : list_)
    if (one.what.kind == MishapKind::tendon_snaps && world.time_s() >= one.what.at_s)
      world.snap(one.actuator);
}

std::vector<const Mishap*> Mishaps::beginning(double time_s, double tick_s) const {
  std::vector<const Mishap*> found;
  for (const Placed& one : list_)
    if (begins(one.what, time_s, tick_s)) found.push_back(&one.what);
  return found;
}

std::vector<Mishaps::OfEcu> Mishaps::of_ecus(double time_s, double tick_s) const {
  std::vector<OfEcu> due;
  for (const Placed& one : list_)
    if (begins(one.what, time_s, tick_s) && of_program(one.what.kind))
      due.push_back({one.what.kind, one.ecu,
                     static_cast<int>(std::min(std::lround(one.what.for_s / tick_s), 65535L))});
  return due;
}

}  // namespace sim
