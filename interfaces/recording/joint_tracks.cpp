#include "interfaces/recording/joint_tracks.hpp"

#include <set>

#include "interfaces/recording/error.hpp"
#include "interfaces/recording/fields.hpp"
#include "interfaces/recording/mcap_reader.hpp"
#include "interfaces/recording/ros2msg.hpp"

namespace recording {
namespace {

constexpr const char* target_topic = "joint_target";

void take(const Members& message, const char* sequence_field, JointTracks& tracks) {
  const auto sequence = integer_in<std::uint64_t>(message, sequence_field);
  each_in(message, "joints", [&](const Members& sample) {
    const Value* position = sample.find("position");
    if (!position || !position->elements() || position->elements()->size() != 4) return;
    JointTrack& track = tracks[text_in(sample, "name")];
    track.dof = static_cast<int>(flags_in(sample, "dof"));
    for (std::size_t i = 0; i < 4; ++i)
      track.positions[sequence][i] = (*position->elements())[i].number().value_or(not_taken);
  });
}

std::string list(const std::set<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text.empty() ? "none" : text;
}

}  // namespace

JointTracks joint_tracks(const McapReader& recording, const std::string& source) {
  std::map<std::uint16_t, TypeDescription> types;
  for (const auto& [id, channel] : recording.channels()) {
    const auto schema = recording.schemas().find(channel.schema_id);
    const bool is_joint_topic = channel.topic == "joint_state" || channel.topic == target_topic;
    if (is_joint_topic && schema != recording.schemas().end() &&
        schema->second.encoding == "ros2msg")
      types[channel.schema_id] = parse_ros2msg(schema->second.name, schema->second.data);
  }
  JointTracks tracks;
  std::set<std::string> sources;
  recording.for_each([&](const Message& message) {
    const auto type = types.find(message.channel.schema_id);
    if (type == types.end()) return;
    const Members members = decode_cdr(type->second, message.data);
    const bool is_target = message.channel.topic == target_topic;
    const std::string message_source = is_target ? target_topic : text_in(members, "source");
    sources.insert(message_source);
    if (message_source == source) take(members, is_target ? "answers" : "sequence", tracks);
  });
  if (!tracks.empty()) return tracks;
  throw RecordingError(recording.path() + ": contains no joints of \"" + source +
                       "\"; recorded sources: " + list(sources));
}

}  // namespace recording
