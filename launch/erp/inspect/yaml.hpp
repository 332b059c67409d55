#pragma once
#include <string>

#include "interfaces/recording/cdr.hpp"

namespace launch {

/// A message as YAML: a line a field, structures indented, sequences of structures as lists of
/// them, sequences of numbers in one line.
std::string to_yaml(const recording::Members& message, int indent = 0);

}  // namespace launch
