#pragma once

namespace launch {

/// Reads the command line of `erp` and does what it says.
/// Exit codes: 0 done, 1 failed, 2 bad usage or input.
int run_command_line(int argc, char** argv);

}  // namespace launch
