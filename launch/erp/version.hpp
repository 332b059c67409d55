#pragma once

/// Which `erp` this is.
namespace launch {

const char* version();   ///< the project's, "0.1.0"
const char* revision();  ///< of git at build time, "-dirty" with uncommitted changes; or "unknown"

}  // namespace launch
