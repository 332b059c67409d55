#pragma once
#include <ostream>
#include <string>

namespace recording {

class McapReader;

/// Writes any topic as CSV with one row per message: `log_time_ns`, then one column per field,
/// named by its path. Elements with a name appear by name (`actuators.flexor.tension_N`), others by
/// index (`age_bins[3]`). Throws RecordingError when the messages cannot be decoded or the topic
/// does not exist; that error lists the recorded topics.
void write_topic_csv(const McapReader& recording, const std::string& topic, std::ostream& out);

}  // namespace recording
