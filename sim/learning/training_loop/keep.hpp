#pragma once
#include <string>

namespace sim::training_loop {

/// The file appears whole or not at all, in place of what was there. Throws std::invalid_argument
/// where it cannot be written.
void keep(const std::string& file, const std::string& text);

}  // namespace sim::training_loop
