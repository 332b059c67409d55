#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace launch::gap {

std::string sha256(const std::string& text);

/// The fraction of the gap that what was hidden closes, with its true parameters as the library
/// has them, on the recordings that the diagnosis held out. Nothing: it is not in the library.
std::optional<double> closed_by_truth(const std::string& folder,
                                      const nlohmann::ordered_json& truth);

}  // namespace launch::gap
