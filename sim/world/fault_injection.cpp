#include "sim/world/fault_injection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace sim {

namespace {

bool is_program_fault(FaultKind kind) {
  return kind == FaultKind::hang || kind == FaultKind::busy || kind == FaultKind::bus_off;
}

}  // namespace

bool FaultInjection::needs_separate_ecus() const {
  return std::ranges::any_of(
      list_, [](const Placed& placed) { return is_program_fault(placed.fault.kind); });
}

FaultInjection::FaultInjection(std::vector<InjectedFault> list, const erp::Robot& robot) {
  for (InjectedFault& fault : list) {
    const auto match = std::ranges::find(robot.actuators, fault.on, &erp::Actuator::name);
    if (match == robot.actuators.end())
      throw std::invalid_argument("<fault on=\"" + fault.on +
                                  "\">: the robot has no such actuator");
    const auto k = static_cast<std::size_t>(match - robot.actuators.begin());
    list_.push_back({std::move(fault), k, match->ecu});
  }
}

void FaultInjection::apply_fault(std::size_t k, double time_s, const SensorScale& scale,
                                 const ecu_inputs& last, ecu_inputs& inputs) const {
  for (const Placed& placed : list_) {
    if (placed.actuator != k || !is_active(placed.fault, time_s)) continue;
    const auto counts = static_cast<std::uint16_t>(placed.fault.counts);
    switch (placed.fault.kind) {
      case FaultKind::tension_open:
        inputs.tension_counts = static_cast<std::uint16_t>(scale.tension_counts_max);
        break;
      case FaultKind::tension_short:
        inputs.tension_counts = 0;
        break;
      case FaultKind::tension_stuck:
        inputs.tension_counts = last.tension_counts;
        break;
      case FaultKind::current_stuck:
        inputs.current_counts = last.current_counts;
        break;
      case FaultKind::encoder_lost:
        inputs.encoder_counts = last.encoder_counts;
        break;
      case FaultKind::encoder_slips:
        inputs.encoder_counts += static_cast<std::int32_t>(
            std::lround(std::numbers::pi / 2 / scale.shaft_rad_per_count));
        break;
      case FaultKind::over_current:
        inputs.current_counts = static_cast<std::int16_t>(scale.current_counts_max);
        break;
      case FaultKind::hot:
        inputs.temperature_counts = counts;
        break;
      case FaultKind::supply_low:
        inputs.supply_counts = counts;
        break;
      default:
        break;
    }
  }
}

void FaultInjection::apply_fault(World& world) const {
  for (const Placed& placed : list_)
    if (placed.fault.kind == FaultKind::tendon_snaps && world.time_s() >= placed.fault.at_s)
      world.snap(placed.actuator);
}

bool FaultInjection::has(FaultKind kind) const {
  return std::ranges::any_of(list_, [&](const Placed& p) { return p.fault.kind == kind; });
}

std::vector<FaultInjection::Beginning> FaultInjection::beginning(double time_s,
                                                                 double tick_s) const {
  std::vector<Beginning> beginning_faults;
  for (const Placed& placed : list_)
    if (begins(placed.fault, time_s, tick_s))
      beginning_faults.push_back({&placed.fault, placed.ecu});
  return beginning_faults;
}

std::vector<FaultInjection::ProgramFault> FaultInjection::program_faults(double time_s,
                                                                         double tick_s) const {
  std::vector<ProgramFault> program_faults_now;
  for (const Placed& placed : list_)
    if (begins(placed.fault, time_s, tick_s) && is_program_fault(placed.fault.kind))
      program_faults_now.push_back(
          {placed.fault.kind, placed.ecu,
           static_cast<int>(std::min(std::lround(placed.fault.for_s / tick_s), 65535L))});
  return program_faults_now;
}

}  // namespace sim
