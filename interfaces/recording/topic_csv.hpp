#pragma once
#include <ostream>
#include <string>

namespace recording {

class McapReader;

/// Any topic as CSV, one row a message: `log_time_ns`, then every field by its path; a list of
/// named samples by name (`actuators.flexor.tension_N`), another list by place (`age_bins[3]`).
/// Throws RecordingError when there is no such topic (with those there are) or its messages cannot
/// be decoded.
void write_topic_csv(const McapReader& recording, const std::string& topic, std::ostream& out);

}  // namespace recording
