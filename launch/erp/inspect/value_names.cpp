#include "launch/erp/inspect/value_names.hpp"

#include <map>
#include <vector>

#include "interfaces/values.hpp"

namespace launch {
namespace {

using Names = std::vector<std::string>;

/// Name k belongs to value k.
const std::map<std::string_view, Names> enumeration_names = {
    {"mode", {"off", "voltage", "length", "current", "force"}},
    {"target_mode", {"off", "voltage", "length", "current", "force"}},
    {"ecu_state", {"boot", "idle", "armed", "running", "fault"}},
    {"state", {"boot", "idle", "armed", "running", "fault"}},
    {"safe_action", {"none", "hold", "relax", "damp"}},
    {"lifecycle", {"unconfigured", "inactive", "active", "error", "finalized"}},
    {"target", {"unconfigured", "inactive", "active", "error", "finalized"}},
    {"severity", {"info", "warning", "fault"}}};

/// Name k belongs to bit k.
const Names actuator_bits = {"voltage", "current", "shaft", "line", "tension", "potentiometer"};
const Names joint_bits = {"angle"};

std::string bits(std::uint64_t value, const Names& names) {
  std::string text;
  for (std::size_t k = 0; k < names.size(); ++k)
    if (value >> k & 1) text += (text.empty() ? "" : " ") + names[k];
  return text.empty() ? "nothing" : text;
}

}  // namespace

std::string value_name(std::string_view structure, std::string_view field, std::uint64_t value) {
  if (!structure.starts_with("erp/msg/")) return "";
  if (field == "valid")
    return bits(value, structure.ends_with("JointSample") ? joint_bits : actuator_bits);
  const auto names = enumeration_names.find(field);
  return names != enumeration_names.end() && value < names->second.size() ? names->second[value]
                                                                          : "";
}

}  // namespace launch
