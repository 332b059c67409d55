#pragma once
#include <string>

namespace sim::training_loop {

/// Replaces the file atomically: a reader sees the old text or the new text, never a part. Throws
/// std::invalid_argument if the file cannot be written.
void write_checkpoint(const std::string& file, const std::string& text);

}  // namespace sim::training_loop
