#include "interfaces/recording/recorder.hpp"

namespace recording {

Recorder::Recorder(std::string path, const std::vector<Attachment>& attachments,
                   McapOptions options)
    : file_(std::move(path), options) {
  for (const Attachment& attachment : attachments) file_.attach(attachment);
  file_.flush();
}

std::size_t Recorder::add_topic(const std::string& topic, const MessageType& type) {
  const std::string key = type.name + "\n" + type.schema;
  for (std::size_t i = 0; i < topics_.size(); ++i)
    if (topics_[i].name == topic && topics_[i].type == key) return i;
  std::uint16_t schema = 0;
  if (!type.schema.empty()) {
    const auto known = schemas_.find(key);
    schema = known != schemas_.end() ? known->second
                                     : file_.add_schema(type.name, "ros2msg", type.schema);
    schemas_[key] = schema;
  }
  if (!type.idl.empty() && idls_.insert(type.name).second)
    file_.attach(type.name + ".idl", "text/plain", type.idl);
  topics_.push_back({topic, key, schema, {}});
  counts_.push_back({topic});
  return topics_.size() - 1;
}

Recorder::Writer& Recorder::writer_of(std::size_t topic, std::string_view name) {
  Topic& of = topics_.at(topic);
  if (const auto known = of.writers.find(name); known != of.writers.end()) return known->second;
  const std::string key(name);
  const auto channel = file_.add_channel(of.name, "cdr", of.schema, {{"writer", key}});
  ++counts_[topic].writers;
  return of.writers.emplace(key, Writer{channel, {}}).first->second;
}

void Recorder::write(std::size_t topic, const Sample& sample) {
  Writer& writer = writer_of(topic, sample.writer);
  TopicCount& count = counts_[topic];
  if (sample.sequence && writer.last) {
    if (*sample.sequence <= *writer.last) ++count.restarts;
    else count.missing += *sample.sequence - *writer.last - 1;
  }
  writer.last = sample.sequence;
  ++count.messages;
  file_.write(writer.channel, static_cast<std::uint32_t>(sample.sequence.value_or(0)),
              sample.log_time_ns, sample.publish_time_ns, sample.cdr);
  waiting_ = true;
}

void Recorder::tick(std::int64_t monotonic_ns) {
  if (!waiting_) return;
  if (!waiting_since_ns_) waiting_since_ns_ = monotonic_ns;
  if (monotonic_ns - *waiting_since_ns_ >= flush_period_ns) flush();
}

void Recorder::flush() {
  file_.flush();
  waiting_ = false;
  waiting_since_ns_.reset();
}

void Recorder::close() { file_.close(); }

std::uint64_t Recorder::missing() const {
  std::uint64_t sum = 0;
  for (const TopicCount& count : counts_) sum += count.missing;
  return sum;
}

}  // namespace recording
