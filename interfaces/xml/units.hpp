#pragma once
#include <string>

namespace xml {

/// The unit at the end of an attribute name, as printed: "rate_N_per_s" → "N/s",
/// "inertia_kg_m2" → "kg m²", "kp_per_s2" → "1/s²". Empty for a name without a unit.
std::string unit_of(const std::string& name);

}  // namespace xml
