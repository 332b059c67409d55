// The plant's part in the gains of the ECUs: who may change them, and what their ECUs answer.
#include <set>
#include <utility>

#include "components/plant/plant.hpp"

namespace plant {
namespace {

/// An ECU that is longer in state boot is lost. Chosen: 20 attempts to load its gains.
constexpr std::int64_t max_boot_ns = 2'000'000'000;

}  // namespace

void Plant::observe_gains(std::size_t actuator, const erp::EcuChannelSample& counts,
                          std::int64_t now_ns) {
  const std::string& name = channels_[actuator].name();
  ChannelGains& gains = gains_[actuator];
  const auto result = gains.observe(static_cast<ecu_state>(counts.state), counts.gain_sets_accepted,
                                    counts.gain_sets_refused, now_ns);
  if (result == ChannelGains::Result::accepted)
    notices_.push_back({erp::Severity::info, name, "gains", "its ECU accepted " + gains.text()});
  if (result == ChannelGains::Result::refused)
    notices_.push_back({erp::Severity::warning, name, "gain_refused",
                        "its ECU refused " + gains.text() + "; the last accepted gains stay"});
  if (result == ChannelGains::Result::unanswered)
    notices_.push_back({erp::Severity::warning, name, "gain_refused",
                        "its ECU did not answer " + gains.text() + "; send them again"});
  std::int64_t& since_ns = boot_since_ns_[actuator];
  if (!gains.is_booting()) since_ns = 0;
  else if (!since_ns) since_ns = now_ns;
  const bool stays = since_ns && now_ns - since_ns > max_boot_ns;
  if (stays && !std::exchange(reported_[actuator].stays_in_boot, stays))
    notices_.push_back({erp::Severity::fault, name, "gains_missing",
                        "its ECU stays in state boot: it does not accept the gains of robot.xml; "
                        "compare the versions of the firmware, and check the bus"});
  reported_[actuator].stays_in_boot = stays;
}

std::string Plant::refusal(const erp::GainCommand& command, const erp::GainValue& gain) const {
  const auto actuator = index_of(gain.name);
  if (!actuator) return std::string("there is no actuator ") + gain.name;
  const ActuatorChannel& channel = channels_[*actuator];
  if (!channel.may_command(command.controller, command.priority))
    return std::string(channel.owner()) + " is the owner; refused gains from " +
           command.controller + " of equal or lower priority";
  return gains_[*actuator].refusal(gain.parameter, gain.value);
}

void Plant::refuse(const std::string& actuator, const std::string& reason) {
  if (const auto index = index_of(actuator)) channels_[*index].refuse_gains(reason);
  if (refused_gains_.is_new(actuator + " " + reason))
    notices_.push_back({erp::Severity::warning, actuator, "gain_refused", reason});
}

/// If one value of an actuator is refused, all its values are.
void Plant::receive(const erp::GainCommand& command) {
  std::set<std::string> refused;
  for (const auto& gain : erp::samples(command.gains))
    if (const auto reason = refusal(command, gain); !reason.empty())
      refused.insert(gain.name), refuse(gain.name, reason);
  for (const auto& gain : erp::samples(command.gains))
    if (!refused.contains(gain.name))
      gains_[*index_of(gain.name)].propose(gain.parameter, gain.value);
}

const erp::EcuParameter& Plant::gains(std::int64_t now_ns, bool load) {
  parameters_.values._length = 0;
  for (ChannelGains& gains : gains_) {
    if (load && gains.is_booting()) gains.append_all(parameters_);
    gains.append_next(parameters_, now_ns);
  }
  zeros_.append_next(parameters_, now_ns);
  return parameters_;
}

}  // namespace plant
