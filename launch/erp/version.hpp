#pragma once

/// Version of this `erp`.
namespace launch {

const char* version();   ///< of the project, "0.1.0"
const char* revision();  ///< of git, "-dirty" with uncommitted changes; or "unknown"

}  // namespace launch
