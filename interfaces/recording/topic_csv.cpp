#include "interfaces/recording/topic_csv.hpp"

#include <functional>
#include <map>
#include <set>
#include <unordered_map>
#include <vector>

#include "interfaces/recording/cdr.hpp"
#include "interfaces/recording/csv.hpp"
#include "interfaces/recording/mcap_reader.hpp"
#include "interfaces/recording/ros2msg.hpp"

namespace recording {
namespace {

using LeafCallback = std::function<void(const std::string& path, const Value& value)>;

/// Calls `callback` for each primitive value with its path, `actuators.flexor.tension_N`.
void each_leaf(const std::string& path, const Value& value, const LeafCallback& callback);

void each_leaf(const std::string& path, const Members& members, const LeafCallback& callback,
               bool skip_name) {
  for (std::size_t i = 0; i < members.fields.size(); ++i) {
    const std::string& field = members.type->fields[i].name;
    if (skip_name && field == "name") continue;
    each_leaf(path.empty() ? field : path + "." + field, members.fields[i], callback);
  }
}

void each_leaf(const std::string& path, const Value& value, const LeafCallback& callback) {
  if (const Members* members = value.members()) return each_leaf(path, *members, callback, false);
  const Values* elements = value.elements();
  if (!elements) return callback(path, value);
  for (std::size_t i = 0; i < elements->size(); ++i) {
    const Members* members = (*elements)[i].members();
    const Value* name = members ? members->find("name") : nullptr;
    if (name && name->text()) each_leaf(path + "." + *name->text(), *members, callback, true);
    else each_leaf(path + "[" + std::to_string(i) + "]", (*elements)[i], callback);
  }
}

class TopicReader {
 public:
  TopicReader(const McapReader& recording, const std::string& topic)
      : recording_(recording), topic_(topic) {
    std::set<std::string> topics;
    for (const auto& [id, channel] : recording.channels()) {
      topics.insert(channel.topic);
      if (channel.topic == topic) add_type(channel);
    }
    if (topics.contains(topic)) return;
    std::string list;
    for (const std::string& name : topics) list += (list.empty() ? "" : ", ") + name;
    throw RecordingError(recording.path() + ": no topic \"" + topic +
                         "\"; recorded topics: " + (list.empty() ? "none" : list));
  }

  template <class Each>
  void for_each(Each&& each) const {
    recording_.for_each([&](const Message& message) {
      if (message.channel.topic != topic_) return;
      each(message, decode_cdr(types_.at(message.channel.schema_id), message.data));
    });
  }

 private:
  void add_type(const Channel& channel) {
    const auto schema = recording_.schemas().find(channel.schema_id);
    if (schema == recording_.schemas().end() || schema->second.encoding != "ros2msg" ||
        channel.message_encoding != "cdr")
      throw RecordingError(recording_.path() + ": topic \"" + topic_ +
                           "\" is not recorded as cdr with a ros2msg schema; export another topic");
    types_.try_emplace(schema->first, parse_ros2msg(schema->second.name, schema->second.data));
  }

  const McapReader& recording_;
  std::string topic_;
  std::map<std::uint16_t, TypeDescription> types_;
};

}  // namespace

void write_topic_csv(const McapReader& recording, const std::string& topic, std::ostream& out) {
  const TopicReader reader(recording, topic);
  std::unordered_map<std::string, std::size_t> column_of;
  std::string header = "log_time_ns";
  reader.for_each([&](const Message&, const Members& members) {
    each_leaf(
        "", members,
        [&](const std::string& path, const Value&) {
          if (column_of.try_emplace(path, column_of.size()).second) header += "," + csv_cell(path);
        },
        false);
  });
  out << header << '\n';
  reader.for_each([&](const Message& message, const Members& members) {
    std::vector<std::string> cells(column_of.size());
    each_leaf(
        "", members,
        [&](const std::string& path, const Value& value) {
          cells[column_of.at(path)] = csv_cell(to_text(value));
        },
        false);
    out << message.log_time_ns;
    for (const std::string& cell : cells) out << ',' << cell;
    out << '\n';
  });
}

}  // namespace recording
