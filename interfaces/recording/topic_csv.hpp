#pragma once
#include <ostream>
#include <string>

namespace recording {

class McapReader;

/// Writes any topic as CSV, one row per message: `log_time_ns`, then every field by its path; a list
/// of named samples by name (`actuators.flexor.tension_N`), another list by index (`age_bins[3]`).
/// Throws RecordingError when the topic does not exist (lists the recorded ones) or its messages
/// cannot be decoded.
void write_topic_csv(const McapReader& recording, const std::string& topic, std::ostream& out);

}  // namespace recording
