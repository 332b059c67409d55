#pragma once

namespace launch {

/// Parses the command line of `erp` and executes its verb.
/// Exit codes: 0 done, 1 failed, 2 bad usage or input.
int run_command_line(int argc, char** argv);

}  // namespace launch
