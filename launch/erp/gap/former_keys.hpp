#pragma once
#include <array>
#include <string>

#include "interfaces/xml/renamed.hpp"

/// Keys in diagnosis.json files of earlier versions.
namespace launch::gap {

struct FormerKey {
  const char *former, *current;
};
inline constexpr std::array former_keys{
    FormerKey{"mend_first", "fix_first"}, FormerKey{"judged_from_s", "held_out_from_s"},
    FormerKey{"confusable", "confounders"}, FormerKey{"judged", "evaluated"}};

/// Renames former keys of one JSON object to their current keys; warns once per file and former
/// key.
template <class Json>
void rename_former_keys(Json& object, const std::string& file) {
  for (const auto& [former, current] : former_keys) {
    if (!object.contains(former) || object.contains(current)) continue;
    xml::warn_renamed({file, 0, 0}, former, current);
    Json value = std::move(object[former]);
    object.erase(former);
    object[current] = std::move(value);
  }
}

/// Parses the text of a diagnosis.json and renames former keys. Throws Json::exception.
template <class Json>
Json parse_diagnosis(const std::string& text, const std::string& file) {
  Json diagnosis = Json::parse(text);
  if (!diagnosis.is_object()) return diagnosis;
  rename_former_keys(diagnosis, file);
  if (const auto residuals = diagnosis.find("residuals");
      residuals != diagnosis.end() && residuals->is_array())
    for (Json& stage : *residuals)
      if (stage.is_object()) rename_former_keys(stage, file);
  return diagnosis;
}

}  // namespace launch::gap
