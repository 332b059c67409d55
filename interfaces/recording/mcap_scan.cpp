#include "interfaces/recording/mcap_scan.hpp"

#include <algorithm>

namespace recording {
namespace {

/// Recordings of robots are compressed by a factor of 5 to 30. A larger one may fill the memory. Chosen.
constexpr std::uint64_t max_unpacked_bytes = std::uint64_t{512} << 20, max_compression = 1000;

/// Largest region of messages outside chunks; chosen: the size of a chunk.
constexpr std::uint64_t max_message_region_bytes = 1u << 20;

class Scanner {
 public:
  /// `earlier`: result of an earlier pass; its schemas and channels replace those in damaged
  /// records.
  Scanner(const InputFile& file, bool tolerant, Contents earlier = {})
      : file_(file), tolerant_(tolerant) {
    contents_.schemas = std::move(earlier.schemas);
    contents_.channels = std::move(earlier.channels);
  }

  Contents run() {
    check_start();
    while (read_record()) {
    }
    return std::move(contents_);
  }

 private:
  void check_start();
  bool read_record();
  bool take(Op op, ByteReader in, std::uint64_t length);
  bool end_early(const RecordHead& head);
  void take_truncated_chunk();
  void take_chunk(ByteReader in, Region region);
  void take_message(ByteReader in, Region region);
  void check_footer(ByteReader in, std::uint64_t length);
  void add(Schema schema, const ByteReader& in);
  void add(Channel channel, const ByteReader& in);
  void require_channel(const MessageHead& head, const ByteReader& in) const;
  void count(const MessageHead& head);
  void set_truncation(const std::string& what, std::uint64_t place);

  const InputFile& file_;
  const bool tolerant_;
  Contents contents_;
  std::uint64_t position_ = 0, unpacked_bytes_ = 0;
  std::uint32_t crc_ = 0, data_crc_ = 0;
};

void Scanner::check_start() {
  const Bytes start = file_.read(0, std::min<std::uint64_t>(magic.size(), file_.size()));
  const auto expected = std::as_bytes(std::span(magic)).first(start.size());
  if (start.empty() || !std::ranges::equal(start, expected))
    throw error_at(file_.path(), 0, "this is not an MCAP file",
                   "give a recording made by the logger");
  if (start.size() < magic.size())
    set_truncation("the file ends inside its first 8 bytes", start.size());
  crc_ = crc32_of(start);
  position_ = start.size();
}

/// Reads the record at `position_`. Returns false at the end of the file or of its data.
bool Scanner::read_record() {
  const std::uint64_t remaining_bytes = file_.size() - position_;
  if (remaining_bytes < record_head_bytes)
    return set_truncation(
               remaining_bytes ? "the file ends inside a record" : "the file ends without a footer",
               position_),
           false;
  const Bytes start = file_.read(position_, record_head_bytes);
  ByteReader in(start, file_.path(), position_);
  const RecordHead head = get_record_head(in);
  if (head.length > remaining_bytes - record_head_bytes) return end_early(head);
  const Bytes body = file_.read(position_ + record_head_bytes, head.length);
  data_crc_ = crc_;
  crc_ = crc32_of(body, crc32_of(start, crc_));
  const std::uint64_t end = position_ + record_head_bytes + head.length;
  try {
    if (!take(head.op, ByteReader(body, file_.path(), position_ + record_head_bytes), head.length))
      return false;
    position_ = end;
  } catch (const RecordingError& error) {
    if (!tolerant_) throw;
    contents_.problems.emplace_back(error.what());
    position_ = std::min(next_valid_record(file_, position_ + 1), std::max(end, position_ + 1));
  }
  return true;
}

bool Scanner::take(Op op, ByteReader in, std::uint64_t length) {
  const Region region{.offset = position_, .length = record_head_bytes + length};
  if (op == Op{0}) in.fail("a record has the kind 0");
  switch (op) {
    case Op::header:
      contents_.profile = in.characters("the profile");
      contents_.library = in.characters("the library");
      break;
    case Op::schema:
      add(get_schema(in), in);
      break;
    case Op::channel:
      add(get_channel(in), in);
      break;
    case Op::message:
      take_message(in, region);
      break;
    case Op::chunk:
      take_chunk(in, region);
      break;
    case Op::attachment:
      contents_.attachments.push_back(get_attachment(in));
      break;
    case Op::metadata:
      contents_.metadata.push_back(get_metadata(in));
      break;
    case Op::data_end: {
      const auto crc = in.integer<std::uint32_t>("the data's checksum");
      if (crc != 0 && crc != data_crc_) in.fail("the data section's checksum does not match");
      break;
    }
    case Op::footer:
      return check_footer(in, length), false;
    default:
      break;  // indexes, and record types that this reader does not know
  }
  return true;
}

void Scanner::add(Schema schema, const ByteReader& in) {
  const auto [existing, is_new] = contents_.schemas.try_emplace(schema.id, schema);
  if (!is_new && existing->second != schema)
    in.fail("schema " + std::to_string(schema.id) + " is defined twice, differently");
}

void Scanner::add(Channel channel, const ByteReader& in) {
  if (channel.schema_id != 0 && !contents_.schemas.contains(channel.schema_id))
    in.fail("channel " + std::to_string(channel.id) + " needs schema " +
            std::to_string(channel.schema_id) + ", which was not defined");
  const auto [existing, is_new] = contents_.channels.try_emplace(channel.id, channel);
  if (!is_new && existing->second != channel)
    in.fail("channel " + std::to_string(channel.id) + " is defined twice, differently");
}

void Scanner::require_channel(const MessageHead& head, const ByteReader& in) const {
  if (!contents_.channels.contains(head.channel_id))
    in.fail("a message is of channel " + std::to_string(head.channel_id) +
            ", which was not defined");
}

void Scanner::count(const MessageHead& head) {
  contents_.statistics[head.channel_id].count(head);
  ++contents_.messages;
}

void Scanner::take_message(ByteReader in, Region region) {
  const MessageHead head = get_message(in);
  require_channel(head, in);
  auto& regions = contents_.regions;
  const bool extends = !regions.empty() && !regions.back().chunk &&
                       regions.back().offset + regions.back().length == region.offset &&
                       regions.back().length < max_message_region_bytes;
  if (extends) regions.back().length += region.length;
  else regions.push_back(region);
  regions.back().count(head);
  count(head);
}

/// Takes all messages of a chunk, or none.
void Scanner::take_chunk(ByteReader in, Region region) {
  const ByteReader chunk = in;
  const Bytes records = unpack(in);
  unpacked_bytes_ += records.size();
  if (unpacked_bytes_ > max_unpacked_bytes && unpacked_bytes_ / max_compression > position_)
    chunk.fail("the chunks up to here unpack to " + std::to_string(unpacked_bytes_) +
               " bytes, more than " + std::to_string(max_compression) + " times their size");
  std::vector<MessageHead> heads;
  ByteReader inside(records, file_.path(), position_, true);
  while (!inside.empty()) {
    const RecordHead head = get_record_head(inside);
    ByteReader body = inside.part(head.length, "a record in a chunk");
    if (head.op == Op::schema) add(get_schema(body), body);
    if (head.op == Op::channel) add(get_channel(body), body);
    if (head.op != Op::message) continue;
    heads.push_back(get_message(body));
    require_channel(heads.back(), body);
  }
  region.chunk = true;
  for (const auto& head : heads) region.count(head), count(head);
  if (!heads.empty()) contents_.regions.push_back(region);
  ++contents_.chunks;
}

void Scanner::check_footer(ByteReader in, std::uint64_t length) {
  const ByteReader footer_start = in;
  const auto summary_start = in.integer<std::uint64_t>("the summary's place");
  in.integer<std::uint64_t>("the summary offsets' place");
  const auto crc = in.integer<std::uint32_t>("the summary's checksum");
  constexpr std::uint64_t positions_bytes = 2 * sizeof(std::uint64_t);  // before the checksum
  const std::uint64_t checksum_position = position_ + record_head_bytes + positions_bytes;
  const std::uint64_t end = position_ + record_head_bytes + length;
  if (summary_start > position_)
    footer_start.fail("the summary starts after the footer, according to the footer");
  if (summary_start != 0 && crc != 0 &&
      crc != crc32_of(file_.read(summary_start, checksum_position - summary_start)))
    footer_start.fail("the summary's checksum does not match");
  const Bytes last = file_.read(end, std::min<std::uint64_t>(file_.size() - end, magic.size() + 1));
  const auto expected = std::as_bytes(std::span(magic));
  if (last.size() < magic.size() && std::ranges::equal(last, expected.first(last.size())))
    return set_truncation("the file ends inside its last 8 bytes", end);
  if (!std::ranges::equal(last, expected))
    footer_start.fail("the file does not end with MCAP's 8 bytes");
  contents_.complete = true;
}

void Scanner::set_truncation(const std::string& what, std::uint64_t place) {
  if (contents_.truncation.empty())
    contents_.truncation = file_.path() + ": byte " + std::to_string(place) + ": " + what;
}

/// Handles a record that extends beyond the end: the recorder was killed, or the length is wrong.
bool Scanner::end_early(const RecordHead& head) {
  set_truncation("the file ends inside a record of " + std::to_string(head.length) + " bytes",
                 position_);
  if (!tolerant_) return false;
  const std::uint64_t next = next_valid_record(file_, position_ + 1);
  if (next == file_.size() && head.op == Op::chunk) take_truncated_chunk();
  position_ = next;
  return next < file_.size();
}

/// Takes the complete messages at the start of a truncated chunk.
void Scanner::take_truncated_chunk() {
  Region region{
      .offset = position_, .length = file_.size() - position_, .chunk = true, .truncated = true};
  std::vector<MessageHead> heads;
  try {
    const LoadedRegion loaded = load(file_, region);
    ByteView data;
    for (std::size_t i = 0; i < loaded.messages.size(); ++i) {
      heads.push_back(loaded.message(i, file_.path(), data));
      require_channel(heads.back(), ByteReader({}, file_.path(), position_));
    }
  } catch (const RecordingError&) {
    return;  // the chunk's head is incomplete, or it is not a chunk
  }
  for (const auto& head : heads) region.count(head), count(head);
  if (!heads.empty()) contents_.regions.push_back(region);
}

}  // namespace

Contents scan(const InputFile& file, bool tolerant) {
  Contents contents = Scanner(file, tolerant).run();
  // The summary repeats schemas and channels: a second pass can use those of damaged records.
  if (!contents.problems.empty()) return Scanner(file, true, std::move(contents)).run();
  return contents;
}

void ChannelStatistics::count(const MessageHead& head) {
  first_ns = messages ? std::min(first_ns, head.log_time_ns) : head.log_time_ns;
  last_ns = std::max(last_ns, head.log_time_ns);
  const auto stamp_ns = static_cast<std::int64_t>(head.publish_time_ns);
  if (!messages) first_stamp_ns = stamp_ns;
  times.add(stamp_ns, head.sequence, head.log_time_ns);
  if (messages++ > 0) {
    // MCAP stores 32 bits of the number: a step of more than half their range is a restart.
    const std::uint32_t step = head.sequence - last_sequence;
    if (step > 0x8000'0000u) ++restarts;
    else if (step > 1) missing += step - 1;
  }
  last_sequence = head.sequence;
}

}  // namespace recording
