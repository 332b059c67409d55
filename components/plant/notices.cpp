// The notices of the plant, one per change: owner, limited or refused references, ECU faults,
// tendons, limbs.
#include <algorithm>

#include "components/plant/plant.hpp"
#include "firmware/core/fault_names.h"

namespace plant {
namespace {

constexpr std::size_t min_group = 3;  // chosen: equal notices that are merged
constexpr std::size_t max_names = 3;  // chosen: names in a merged notice

bool differ_in_subject_only(const Notice& a, const Notice& b) {
  return a.severity == b.severity && a.code == b.code && a.text == b.text && !a.subject.empty() &&
         !b.subject.empty();
}

std::string names_of(const std::vector<Notice>& group) {
  std::string names;
  for (std::size_t i = 0; i < std::min(max_names, group.size()); ++i)
    names += (i ? ", " : "") + group[i].subject;
  return group.size() > max_names ? names + " …" : names;
}

Notice merge(const std::vector<Notice>& group, std::size_t actuators) {
  Notice merged = group.front();
  const bool is_all = group.size() == actuators;
  if (!is_all) merged.text += " (" + names_of(group) + ")";
  merged.subject = (is_all ? "all " : "") + std::to_string(group.size()) + " actuators";
  return merged;
}

std::string safe_action_text(erp::SafeAction action) {
  switch (action) {
    case erp::SafeAction::hold:
      return "; holding the line length";
    case erp::SafeAction::relax:
      return "; relaxing the tendon";
    case erp::SafeAction::damp:
      return "; damping";
    case erp::SafeAction::none:
      break;
  }
  return "";
}

std::string owner_text(const ActuatorChannel& channel, const std::string& previous_owner) {
  const std::string owner(channel.owner());
  if (channel.is_emergency_off())
    return "emergency off by " + owner + "; release it with: erp stop --release";
  if (!owner.empty()) return "driven by " + owner;
  return previous_owner + (channel.is_released() ? " released it" : " became stale") +
         safe_action_text(channel.safe_action());
}

Notice owner_notice(const ActuatorChannel& channel, const std::string& previous_owner) {
  const std::string text = owner_text(channel, previous_owner);
  if (channel.is_emergency_off())
    return {erp::Severity::warning, channel.name(), "emergency_off", text};
  if (!channel.owner().empty()) return {erp::Severity::info, channel.name(), "owner", text};
  if (channel.is_released()) return {erp::Severity::info, channel.name(), "released", text};
  return {erp::Severity::warning, channel.name(), "stale_command", text};
}

/// The reason why a reference was limited or refused; names the owner if its priority decided.
std::string limit_text(const ActuatorChannel& channel) {
  if (channel.reason() != outranked_reason) return std::string(channel.reason());
  return std::string(channel.owner()) +
         " is the owner; refused a command of equal or lower priority, raise its --priority";
}

}  // namespace

std::vector<Notice> merge_similar(std::vector<Notice> notices, std::size_t actuators) {
  std::vector<Notice> merged;
  while (!notices.empty()) {
    const auto others = std::stable_partition(
        notices.begin(), notices.end(),
        [first = notices.front()](const Notice& n) { return differ_in_subject_only(n, first); });
    std::vector<Notice> group(notices.begin(), std::max(others, notices.begin() + 1));
    notices.erase(notices.begin(), notices.begin() + static_cast<std::ptrdiff_t>(group.size()));
    if (group.size() >= min_group) merged.push_back(merge(group, actuators));
    else merged.insert(merged.end(), group.begin(), group.end());
  }
  return merged;
}

void Plant::notice_tendon(const ActuatorChannel& channel, Reported& reported) {
  if (channel.tendon() == reported.tendon) return;
  reported.tendon = channel.tendon();
  if (reported.tendon == TendonState::snapped)
    notices_.push_back(
        {erp::Severity::fault, channel.name(), "tendon_snapped",
         "no tension after winding up take_up_m: off until its controller commands mode off"});
  if (reported.tendon == TendonState::slack && !std::exchange(reported.slack, true))
    notices_.push_back({erp::Severity::warning, channel.name(), "tendon_slack",
                        "no tension for 16 ms: winding up the slack slowly"});
}

void Plant::notice_limb(std::size_t actuator) {
  Reported& reported = reported_[actuator];
  const std::string& name = channels_[actuator].name();
  const bool lost = limb_monitor_.lost(actuator),
             degraded = limb_monitor_.degraded(actuator) && !lost;
  if (lost && !reported.lost)
    notices_.push_back({erp::Severity::fault, name, "ecu_lost",
                        "no message from its ECU: its state is unknown; check power and bus"});
  if (degraded && !reported.degraded)
    notices_.push_back({erp::Severity::warning, name, "limb_degraded",
                        "another ECU of its limb is lost: taking its safe action"});
  reported.lost = lost, reported.degraded = degraded;
}

void Plant::notice_changes() {
  std::ranges::move(zeros_.take_notices(), std::back_inserter(notices_));
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    const ActuatorChannel& channel = channels_[i];
    Reported& reported = reported_[i];
    if (reported.owner != channel.owner()) {
      notices_.push_back(owner_notice(channel, reported.owner));
      reported.owner = channel.owner();
    }
    if (channel.state() != reported.state && channel.state() == ECU_STATE_FAULT)
      notices_.push_back({erp::Severity::fault, channel.name(), "ecu_fault",
                          ecu_fault_name(frame_.actuators._buffer[i].ecu_fault)});
    reported.state = channel.state();
    notice_tendon(channel, reported);
    notice_limb(i);
    // Only the first limited or refused reference is reported; actuator_owner publishes the
    // counters.
    const bool first =
        (channel.limited() && !reported.limited) || (channel.refused() && !reported.refused);
    if (first)
      notices_.push_back(
          {erp::Severity::warning, channel.name(), "reference", limit_text(channel)});
    reported.limited = channel.limited(), reported.refused = channel.refused();
  }
}

const erp::ActuatorOwner& Plant::owners() {
  owner_message_.stamp_ns = frame_.stamp_ns;
  for (std::size_t i = 0; i < channels_.size(); ++i) {
    const ActuatorChannel& channel = channels_[i];
    auto& sample = owner_message_.actuators._buffer[i];
    erp::assign(sample.owner, channel.owner());
    sample.priority = channel.priority();
    sample.safe_action = static_cast<std::uint8_t>(channel.safe_action());
    sample.limited = channel.limited();
    sample.refused = channel.refused() + channel.refused_gains();
    erp::assign_shortened(sample.reason, channel.reason());
  }
  return owner_message_;
}

}  // namespace plant
