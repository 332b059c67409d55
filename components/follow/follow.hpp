#pragma once
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "components/node/run.hpp"
#include "firmware/core/laws.h"
#include "interfaces/topics.hpp"
#include "sim/control/gain_design.hpp"

/// Follows actuator targets with one of the firmware's laws: at the ECU, by passing the reference
/// on, or on the host, by running the same law here and sending voltages.
///
///   where="ecu"    target → actuator_command in the law's own mode
///   where="host"   u = law(target, measured);  actuator_command in mode voltage
namespace follow {

enum class Where { ecu, host };

struct Params {
  Where where = Where::ecu;
  double stale_s = 0.1;
  void visit(auto& v) {
    v("where", where,
      "Place of the law: ecu passes targets on to the ECU's mode, host runs the same law here and "
      "commands voltages.");
    v("stale_s", stale_s,
      {xml::positive,
       "Age from which targets are rejected; the plant then takes its safe action; chosen."});
  }
};

/// State of one actuator for the law on the host. The ECU stores the same state.
struct Channel {
  std::array<float, ECU_PARAMETER_COUNT> gains;
  double radius_m;
  std::optional<double> last_shaft_rad;
  std::uint8_t last_valid = 0;
  float gain(ecu_parameter_index index) const { return gains[static_cast<std::size_t>(index)]; }
};

/// `Law` has `static constexpr erp::Mode mode`, `static constexpr std::uint8_t needed` (bits of
/// erp::valid: the measurements that it needs) and
/// `static float voltage_V(const Channel&, float reference, const erp::ActuatorSample&, float
/// speed_rad_per_s)`.
template <class Law>
class Follow {
 public:
  using Params = follow::Params;

  Follow(const Params& params, const erp::Robot& robot) : params_(params) {
    for (const auto& actuator : robot.actuators)
      channels_.emplace_back(
          actuator.name,
          Channel{sim::design_parameters(robot, actuator, {}), actuator.spindle.radius_m, {}});
  }

  /// nullopt if the target is missing or older than `stale_s`: the plant then takes its safe
  /// action.
  std::optional<erp::ActuatorCommand> step(const erp::SensorFrame& frame, double dt_s,
                                           const node::Latest<erp::ActuatorTarget>& target) {
    update_speeds(frame, dt_s);
    if (!target || target.age_s > params_.stale_s) return std::nullopt;
    erp::ActuatorCommand command;
    for (const auto& desired : erp::samples(target->actuators)) {
      const auto* sample = find(frame, desired.name);
      if (!sample || static_cast<erp::Mode>(desired.mode) != Law::mode) continue;
      erp::append(command.actuators, command_for(desired, *sample));
    }
    return command;
  }

 private:
  erp::ActuatorReference command_for(erp::ActuatorReference desired,
                                     const erp::ActuatorSample& sample) {
    if (params_.where == Where::ecu) return desired;
    const std::size_t i = index_of(sample.name);
    const Channel& channel = channels_[i].second;
    const float voltage =
        Law::voltage_V(channel, static_cast<float>(desired.reference), sample, speeds_[i]);
    desired.mode = static_cast<std::uint8_t>(erp::Mode::voltage);
    desired.reference = law_limit_current_V(
        voltage, speeds_[i], channel.gain(ECU_PARAMETER_RESISTANCE),
        channel.gain(ECU_PARAMETER_BACK_EMF), channel.gain(ECU_PARAMETER_CURRENT_LIMIT),
        channel.gain(ECU_PARAMETER_SUPPLY));
    return desired;
  }

  void update_speeds(const erp::SensorFrame& frame, double dt_s) {
    for (const auto& sample : erp::samples(frame.actuators)) {
      const std::size_t i = index_of(sample.name);
      if (i >= channels_.size() || !sample.valid) continue;
      Channel& channel = channels_[i].second;
      auto& last = channel.last_shaft_rad;
      // The angle jumps when the zero of the encoder becomes known.
      if (std::exchange(channel.last_valid, sample.valid) != sample.valid) last.reset();
      speeds_[i] = last && dt_s > 0 ? static_cast<float>((sample.shaft_rad - *last) / dt_s) : 0.0F;
      last = sample.shaft_rad;
    }
  }

  /// An actuator by name; nullptr if a measurement that the law needs is missing.
  static const erp::ActuatorSample* find(const erp::SensorFrame& frame, std::string_view name) {
    for (const auto& sample : erp::samples(frame.actuators))
      if (name == sample.name)
        return (sample.valid & Law::needed) == Law::needed ? &sample : nullptr;
    return nullptr;
  }
  std::size_t index_of(std::string_view name) const {
    std::size_t i = 0;
    while (i < channels_.size() && channels_[i].first != name) ++i;
    return i;
  }

  Params params_;
  std::vector<std::pair<std::string, Channel>> channels_;
  std::array<float, erp::capacity_of<erp::ActuatorSample>> speeds_{};  ///< rad/s, by channel
};

}  // namespace follow

template <>
struct xml::Names<follow::Where> {
  static constexpr auto list = std::to_array<std::pair<const char*, follow::Where>>(
      {{"ecu", follow::Where::ecu}, {"host", follow::Where::host}});
};
