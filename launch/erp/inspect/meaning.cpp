#include "launch/erp/inspect/meaning.hpp"

#include <map>
#include <vector>

#include "interfaces/values.hpp"

namespace launch {
namespace {

using Words = std::vector<std::string>;

/// Word k belongs to number k.
const std::map<std::string_view, Words> words_of = {
    {"mode", {"off", "voltage", "length", "current", "force"}},
    {"target_mode", {"off", "voltage", "length", "current", "force"}},
    {"ecu_state", {"boot", "idle", "armed", "running", "fault"}},
    {"state", {"boot", "idle", "armed", "running", "fault"}},
    {"safe_action", {"none", "hold", "relax", "damp"}},
    {"lifecycle", {"unconfigured", "inactive", "active", "error", "finalized"}},
    {"target", {"unconfigured", "inactive", "active", "error", "finalized"}},
    {"severity", {"info", "warning", "fault"}}};

/// Word k belongs to bit k.
const Words actuator_bits = {"voltage", "current", "shaft", "line", "tension", "potentiometer"};
const Words joint_bits = {"angle"};

std::string bits(std::uint64_t value, const Words& words) {
  std::string text;
  for (std::size_t k = 0; k < words.size(); ++k)
    if (value >> k & 1) text += (text.empty() ? "" : " ") + words[k];
  return text.empty() ? "nothing" : text;
}

}  // namespace

std::string meaning_of(std::string_view structure, std::string_view field, std::uint64_t value) {
  if (!structure.starts_with("erp/msg/")) return "";
  if (field == "valid")
    return bits(value, structure.ends_with("JointSample") ? joint_bits : actuator_bits);
  const auto words = words_of.find(field);
  return words != words_of.end() && value < words->second.size() ? words->second[value] : "";
}

}  // namespace launch
