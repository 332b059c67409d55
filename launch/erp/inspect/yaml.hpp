#pragma once
#include <string>

#include "interfaces/recording/cdr.hpp"

namespace launch {

/// A message as YAML: one line per field, structures indented, sequences of structures as lists,
/// sequences of numbers on one line.
std::string to_yaml(const recording::Members& message, int indent = 0);

}  // namespace launch
