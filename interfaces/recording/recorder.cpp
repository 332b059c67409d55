#include "interfaces/recording/recorder.hpp"

namespace recording {

static McapOptions continuing(McapOptions options) {
  options.continue_after_failure = true;
  return options;
}

Recorder::Recorder(std::string path, const std::vector<Attachment>& attachments,
                   McapOptions options)
    : file_(std::move(path), continuing(options)) {
  for (const Attachment& attachment : attachments) file_.attach(attachment);
  file_.flush();
}

std::size_t Recorder::add_topic(const std::string& topic, const MessageType& type) {
  const std::string key = type.name + "\n" + type.schema;
  for (std::size_t i = 0; i < topics_.size(); ++i)
    if (topics_[i].name == topic && topics_[i].type == key) return i;
  std::uint16_t schema = 0;
  if (!type.schema.empty()) {
    const auto existing = schemas_.find(key);
    schema = existing != schemas_.end() ? existing->second
                                        : file_.add_schema(type.name, "ros2msg", type.schema);
    schemas_[key] = schema;
  }
  attach_idl(type);
  topics_.push_back({topic, key, schema, {}});
  counts_.push_back({topic});
  return topics_.size() - 1;
}

/// Without space it is left out: readers need only the schema.
void Recorder::attach_idl(const MessageType& type) {
  if (type.idl.empty() || !idls_.insert(type.name).second) return;
  try {
    file_.attach(type.name + ".idl", "text/plain", type.idl);
  } catch (const WriteError&) {
    idls_.erase(type.name);
  }
}

Recorder::Writer& Recorder::writer_of(std::size_t topic, std::string_view name) {
  Topic& entry = topics_.at(topic);
  if (const auto existing = entry.writers.find(name); existing != entry.writers.end())
    return existing->second;
  const std::string key(name);
  const auto channel = file_.add_channel(entry.name, "cdr", entry.schema, {{"writer", key}});
  ++counts_[topic].writers;
  return entry.writers.emplace(key, Writer{channel, {}}).first->second;
}

void Recorder::write(std::size_t topic, const Sample& sample) {
  Writer& writer = writer_of(topic, sample.writer);
  TopicCount& count = counts_[topic];
  if (sample.sequence && writer.last_sequence) {
    if (*sample.sequence <= *writer.last_sequence) ++count.restarts;
    else count.missing += *sample.sequence - *writer.last_sequence - 1;
  }
  writer.last_sequence = sample.sequence;
  ++count.messages;
  file_.write(writer.channel, static_cast<std::uint32_t>(sample.sequence.value_or(0)),
              sample.log_time_ns, sample.publish_time_ns, sample.cdr);
  has_unflushed_data_ = true;
}

void Recorder::tick(std::int64_t monotonic_ns) {
  if (!has_unflushed_data_) return;
  if (!unflushed_since_ns_) unflushed_since_ns_ = monotonic_ns;
  if (monotonic_ns - *unflushed_since_ns_ >= flush_period_ns) flush();
}

void Recorder::flush() {
  file_.flush();
  has_unflushed_data_ = false;
  unflushed_since_ns_.reset();
}

/// The file contains how many messages were lost, and when.
void Recorder::close() {
  if (file_.lost().count) {
    file_.flush();
    file_.add_metadata({"lost_messages",
                        {{"count", std::to_string(file_.lost().count)},
                         {"first_log_time_ns", std::to_string(file_.lost().first_ns)},
                         {"last_log_time_ns", std::to_string(file_.lost().last_ns)}}});
  }
  file_.close();
}

std::uint64_t Recorder::missing() const {
  std::uint64_t sum = 0;
  for (const TopicCount& count : counts_) sum += count.missing;
  return sum;
}

}  // namespace recording
