// The plant's part in the gains of the ECUs: who may change them, and what their ECUs answer.
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

void Plant::propose(const erp::GainCommand& command, const erp::GainValue& gain) {
  const std::string name = gain.name;
  std::string refused = "there is no actuator " + name;
  for (std::size_t i = 0; i < channels_.size(); ++i)
    if (channels_[i].name() == name)
      refused = channels_[i].may_command(command.controller, command.priority)
                    ? gains_[i].propose(gain.parameter, gain.value)
                    : std::string(channels_[i].owner()) + " is the owner; refused gains from " +
                          command.controller + " of equal or lower priority";
  if (refused.empty()) return;
  for (ActuatorChannel& channel : channels_)
    if (channel.name() == name) channel.refuse_gains(refused);
  if (refused_gains_.is_new(name + " " + refused))
    notices_.push_back({erp::Severity::warning, name, "gain_refused", refused});
}

void Plant::receive(const erp::GainCommand& command) {
  for (const auto& gain : erp::samples(command.gains)) propose(command, gain);
}

const erp::EcuParameter& Plant::gains(std::int64_t now_ns, bool load) {
  parameters_.values._length = 0;
  for (ChannelGains& gains : gains_) {
    if (load && gains.is_booting()) gains.append_all(parameters_);
    gains.append_next(parameters_, now_ns);
  }
  return parameters_;
}

}  // namespace plant
