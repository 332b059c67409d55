// What the plant says, once a change: who drives, what was limited or refused, what an ECU reports.
#include "components/plant/plant.hpp"
#include "firmware/core/fault_names.h"

namespace plant {
namespace {

std::string owner_text(const Drive& drive, const std::string& before) {
  if (!drive.owner().empty()) return "driven by " + std::string(drive.owner());
  switch (drive.safe_action()) {
    case erp::SafeAction::hold:
      return before + " went stale; holding the line";
    case erp::SafeAction::relax:
      return before + " went stale; relaxing the tendon";
    case erp::SafeAction::damp:
      return before + " went stale; damping";
    case erp::SafeAction::none:
      break;
  }
  return before + " went stale";
}

/// Why a reference was changed or refused; of a controller that may not drive, who does.
std::string limit_text(const Drive& drive) {
  if (drive.reason() != outranked_reason) return std::string(drive.reason());
  return std::string(drive.owner()) +
         " drives, another controller would like to; the higher --priority wins";
}

}  // namespace

void Plant::notice_tendon(const Drive& drive, Said& said) {
  if (drive.tendon() == said.tendon) return;
  said.tendon = drive.tendon();
  if (said.tendon == Tautness::snapped)
    notices_.push_back({erp::Severity::fault, drive.name(), "tendon_snapped",
                        "nothing pulls back however much is wound: off until the driver says off"});
  if (said.tendon == Tautness::slack && !std::exchange(said.slack, true))
    notices_.push_back({erp::Severity::warning, drive.name(), "tendon_slack",
                        "no tension for 16 ms: the slack is wound up slowly"});
}

void Plant::notice_limb(std::size_t actuator) {
  Said& said = said_[actuator];
  const std::string& name = drives_[actuator].name();
  const bool lost = limbs_.lost(actuator), broken = limbs_.broken(actuator) && !lost;
  if (lost && !said.lost)
    notices_.push_back({erp::Severity::fault, name, "ecu_lost",
                        "no word of its ECU: off, as far as anyone knows"});
  if (broken && !said.broken)
    notices_.push_back({erp::Severity::warning, name, "limb_broken",
                        "one that it works with is lost: it drops to its safe action"});
  said.lost = lost, said.broken = broken;
}

void Plant::notice_changes() {
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    const Drive& drive = drives_[i];
    Said& said = said_[i];
    if (said.owner != drive.owner()) {
      const bool lost = drive.owner().empty();
      notices_.push_back({lost ? erp::Severity::warning : erp::Severity::info, drive.name(),
                          lost ? "stale_command" : "owner", owner_text(drive, said.owner)});
      said.owner = drive.owner();
    }
    if (drive.state() != said.state && drive.state() == ECU_STATE_FAULT)
      notices_.push_back({erp::Severity::fault, drive.name(), "ecu_fault",
                          ecu_fault_name(frame_.actuators._buffer[i].ecu_fault)});
    said.state = drive.state();
    notice_tendon(drive, said);
    notice_limb(i);
    // The first of a row is said; the counters on actuator_owner carry the rest.
    const bool first = (drive.limited() && !said.limited) || (drive.refused() && !said.refused);
    if (first)
      notices_.push_back({erp::Severity::warning, drive.name(), "reference", limit_text(drive)});
    said.limited = drive.limited(), said.refused = drive.refused();
  }
}

const erp::ActuatorOwner& Plant::owners() {
  owners_.stamp_ns = frame_.stamp_ns;
  for (std::size_t i = 0; i < drives_.size(); ++i) {
    const Drive& drive = drives_[i];
    auto& sample = owners_.actuators._buffer[i];
    erp::assign(sample.owner, drive.owner());
    sample.priority = drive.priority();
    sample.safe_action = static_cast<std::uint8_t>(drive.safe_action());
    sample.limited = drive.limited();
    sample.refused = drive.refused();
    erp::assign_shortened(sample.reason, drive.reason());
  }
  return owners_;
}

}  // namespace plant
