#pragma once

namespace erp {

/// Description of the attribute `source` of every element that has one.
inline constexpr const char* source_description =
    "Origin of the values of this element: publication, data sheet, measurement, or \"chosen\". "
    "For readers; it has no effect.";

}  // namespace erp
