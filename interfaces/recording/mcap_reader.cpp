#include "interfaces/recording/mcap_reader.hpp"

#include <algorithm>
#include <cstdio>
#include <list>
#include <memory>
#include <numeric>
#include <queue>

#include "interfaces/recording/mcap_writer.hpp"

namespace recording {
namespace {

constexpr std::size_t max_cached_bytes = std::size_t{256} << 20;  // chosen

/// Loads regions and keeps the most recently used ones in memory. The limit applies also to a
/// recording in which all chunks overlap in time.
class Cache {
 public:
  Cache(const InputFile& file, const std::vector<Region>& regions)
      : file_(file), regions_(regions) {}

  const LoadedRegion& get(std::size_t i) {
    const auto cached = std::ranges::find(recent_, i, &Entry::first);
    if (cached != recent_.end()) {
      recent_.splice(recent_.begin(), recent_, cached);
      return recent_.front().second;
    }
    recent_.emplace_front(i, load(file_, regions_[i]));
    bytes_ += recent_.front().second.records.size();
    while (bytes_ > max_cached_bytes && recent_.size() > 1) {
      bytes_ -= recent_.back().second.records.size();
      recent_.pop_back();
    }
    return recent_.front().second;
  }

 private:
  using Entry = std::pair<std::size_t, LoadedRegion>;
  const InputFile& file_;
  const std::vector<Region>& regions_;
  std::list<Entry> recent_;
  std::size_t bytes_ = 0;
};

/// Read position in one region.
struct Cursor {
  std::shared_ptr<const MessageIndex> messages;
  std::size_t region, next_message;
  std::uint64_t time_ns() const { return (*messages)[next_message].first; }
};
struct IsLater {
  bool operator()(const Cursor& a, const Cursor& b) const {
    return std::pair(a.time_ns(), a.region) > std::pair(b.time_ns(), b.region);
  }
};

/// Skips damaged records.
struct TolerantReader : McapReader {
  explicit TolerantReader(const std::string& path) : McapReader(path, true) {}
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

void McapReader::for_each_in_file_order(const std::function<void(const Message&)>& callback) const {
  for (const Region& region : contents_.regions) {
    const LoadedRegion loaded = load(file_, region);
    std::vector<std::size_t> by_offset(loaded.messages.size());
    std::iota(by_offset.begin(), by_offset.end(), std::size_t{0});
    std::ranges::sort(by_offset, {}, [&](std::size_t i) { return loaded.messages[i].second; });
    for (const std::size_t i : by_offset) emit(loaded, i, callback);
  }
}

void McapReader::for_each(const std::function<void(const Message&)>& callback, Order order) const {
  if (order == Order::file) return for_each_in_file_order(callback);
  const auto& regions = contents_.regions;
  std::vector<std::size_t> regions_by_start(regions.size());
  std::iota(regions_by_start.begin(), regions_by_start.end(), std::size_t{0});
  std::ranges::stable_sort(regions_by_start, {},
                           [&](std::size_t i) { return regions[i].first_ns; });
  std::priority_queue<Cursor, std::vector<Cursor>, IsLater> open_cursors;
  Cache cache(file_, regions);
  auto next_region = regions_by_start.begin();
  for (;;) {
    while (
        next_region != regions_by_start.end() &&
        (open_cursors.empty() || regions[*next_region].first_ns <= open_cursors.top().time_ns())) {
      auto index = std::make_shared<const MessageIndex>(cache.get(*next_region).messages);
      if (!index->empty()) open_cursors.push({std::move(index), *next_region, 0});
      ++next_region;
    }
    if (open_cursors.empty()) return;
    Cursor cursor = open_cursors.top();
    open_cursors.pop();
    emit(cache.get(cursor.region), cursor.next_message, callback);
    if (++cursor.next_message < cursor.messages->size()) open_cursors.push(std::move(cursor));
  }
}

void McapReader::emit(const LoadedRegion& region, std::size_t i,
                      const std::function<void(const Message&)>& callback) const {
  ByteView data;
  const bool exists = i < region.messages.size();
  const MessageHead head = exists ? region.message(i, path(), data) : MessageHead{};
  const auto channel = contents_.channels.find(head.channel_id);
  if (!exists || channel == contents_.channels.end())
    throw RecordingError(path() + ": the file changed while it was read; read a copy");
  callback({channel->second, head.sequence, head.log_time_ns, head.publish_time_ns, data});
}

Recovered recover(const std::string& in, const std::string& out) {
  const TolerantReader reader(in);
  Recovered recovered{.problems = reader.contents().problems};
  if (!reader.truncation().empty()) recovered.problems.push_back(reader.truncation());
  McapWriter writer(out);
  try {
    copy(reader, writer);
  } catch (...) {
    std::remove(out.c_str());  // an incomplete copy must not look like a complete recording
    throw;
  }
  recovered.messages = writer.message_count();
  recovered.attachments = reader.attachments().size();
  return recovered;
}

}  // namespace recording
