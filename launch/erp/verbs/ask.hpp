#pragma once
#include <string>
#include <vector>

/// What a component's program says about its own command line, without starting to work.
namespace launch {

/// Runs `argv --check`, which every component answers with 0, or with 2 and the mistakes on stderr.
/// Returns the mistakes, "" when there are none; a program that gives no answer within 10 s is
/// killed and is a mistake too. Throws std::system_error when it cannot be run.
std::string ask_to_check(std::vector<std::string> argv);

}  // namespace launch
