#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace launch::gap {

/// SHA-256 hash as hexadecimal digits.
std::string sha256(const std::string& text);

/// Gap closure by the hidden effects with their true parameters, on the held-out recordings of the
/// diagnosis. Empty if the library does not contain one of them.
std::optional<double> closed_by_truth(const std::string& folder,
                                      const nlohmann::ordered_json& truth);

}  // namespace launch::gap
