#include "interfaces/recording/mcap_reader.hpp"

#include <algorithm>
#include <cstdio>
#include <memory>
#include <numeric>
#include <queue>

#include "interfaces/recording/mcap_writer.hpp"

namespace recording {
namespace {

/// Where one loaded region is being read.
struct Cursor {
  std::shared_ptr<const LoadedRegion> region;
  std::size_t order, next;
  std::uint64_t time_ns() const { return region->messages[next].first; }
};
struct Later {
  bool operator()(const Cursor& a, const Cursor& b) const {
    return std::pair(a.time_ns(), a.order) > std::pair(b.time_ns(), b.order);
  }
};

struct Damaged : McapReader {
  explicit Damaged(const std::string& path) : McapReader(path, true) {}
};

void copy(const McapReader& reader, McapWriter& writer) {
  std::map<std::uint16_t, std::uint16_t> schema_ids{{0, 0}}, channel_ids;
  for (const auto& [id, schema] : reader.schemas())
    schema_ids[id] = writer.add_schema(schema.name, schema.encoding, schema.data);
  for (const auto& [id, channel] : reader.channels())
    channel_ids[id] = writer.add_channel(channel.topic, channel.message_encoding,
                                         schema_ids.at(channel.schema_id), channel.metadata);
  for (const auto& attachment : reader.attachments()) writer.attach(attachment);
  for (const auto& metadata : reader.contents().metadata) writer.add_metadata(metadata);
  reader.for_each([&](const Message& message) {
    writer.write(channel_ids.at(message.channel.id), message.sequence, message.log_time_ns,
                 message.publish_time_ns, message.data);
  });
  writer.close();
}

}  // namespace

void McapReader::for_each(const std::function<void(const Message&)>& use) const {
  const auto& regions = contents_.regions;
  std::vector<std::size_t> by_start(regions.size());
  std::iota(by_start.begin(), by_start.end(), std::size_t{0});
  std::ranges::stable_sort(by_start, {}, [&](std::size_t i) { return regions[i].first_ns; });
  std::priority_queue<Cursor, std::vector<Cursor>, Later> open;
  std::size_t next = 0;
  for (;;) {
    while (next < by_start.size() &&
           (open.empty() || regions[by_start[next]].first_ns <= open.top().time_ns())) {
      auto loaded = std::make_shared<const LoadedRegion>(load(file_, regions[by_start[next]]));
      if (!loaded->messages.empty()) open.push({std::move(loaded), by_start[next], 0});
      ++next;
    }
    if (open.empty()) return;
    Cursor cursor = open.top();
    open.pop();
    ByteView data;
    const MessageHead head = cursor.region->message(cursor.next, path(), data);
    const auto channel = contents_.channels.find(head.channel_id);
    if (channel == contents_.channels.end())
      throw RecordingError(path() + ": the file changed while it was read; read a copy");
    use({channel->second, head.sequence, head.log_time_ns, head.publish_time_ns, data});
    if (++cursor.next < cursor.region->messages.size()) open.push(std::move(cursor));
  }
}

Recovered recover(const std::string& in, const std::string& out) {
  const Damaged reader(in);
  Recovered recovered{.problems = reader.contents().problems};
  if (!reader.truncation().empty()) recovered.problems.push_back(reader.truncation());
  McapWriter writer(out);
  try {
    copy(reader, writer);
  } catch (...) {
    std::remove(out.c_str());  // half a recording must not look like a whole one
    throw;
  }
  recovered.messages = writer.message_count();
  recovered.attachments = reader.attachments().size();
  return recovered;
}

}  // namespace recording
