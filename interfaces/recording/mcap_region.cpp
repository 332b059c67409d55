#include "interfaces/recording/mcap_region.hpp"

#include <algorithm>

#include "interfaces/recording/compression.hpp"

namespace recording {
namespace {

/// Stores the positions of the messages in `region.records`. At an incomplete record it stops if
/// the region is truncated, and throws otherwise.
void index_messages(LoadedRegion& region, std::string_view path, bool truncated) {
  ByteReader in(region.records, path, region.origin, true);
  try {
    while (!in.empty()) {
      const std::size_t start = in.position();
      const RecordHead head = get_record_head(in);
      ByteReader body = in.part(head.length, "a record in a chunk");
      if (head.op == Op::message)
        region.messages.emplace_back(get_message(body).log_time_ns, start);
    }
  } catch (const RecordingError&) {
    if (!truncated) throw;
  }
  std::stable_sort(region.messages.begin(), region.messages.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
}

Bytes unpack_start(ByteReader in) {
  in.take(16, "a chunk's times");
  const auto size = in.integer<std::uint64_t>("a chunk's size");
  in.take(4, "a chunk's checksum");
  const std::string compression = in.characters("a chunk's compression");
  in.take(8, "a chunk's length");
  return decompress_start(in.rest(), compression, size);
}

bool is_valid(Op op, ByteReader in) {
  try {
    ByteView records;
    switch (op) {
      case Op::schema:
        get_schema(in);
        break;
      case Op::channel:
        get_channel(in);
        break;
      case Op::attachment:
        get_attachment(in);
        break;
      case Op::chunk:
        get_chunk(in, records);
        break;
      default:
        return false;
    }
    return in.empty();
  } catch (const RecordingError&) {
    return false;
  }
}

bool is_valid_at(const InputFile& file, std::uint64_t position) {
  if (file.size() - position < record_head_bytes) return false;
  const Bytes start = file.read(position, record_head_bytes);
  ByteReader in(start, file.path(), position);
  const RecordHead head = get_record_head(in);
  const std::uint64_t body = position + record_head_bytes;
  if (head.length > file.size() - body) return false;
  const Bytes bytes = file.read(body, head.length);
  return is_valid(head.op, ByteReader(bytes, file.path(), body));
}

}  // namespace

void Region::count(const MessageHead& head) {
  first_ns = messages ? std::min(first_ns, head.log_time_ns) : head.log_time_ns;
  last_ns = std::max(last_ns, head.log_time_ns);
  ++messages;
}

RecordHead get_record_head(ByteReader& in) {
  const auto op = static_cast<Op>(in.integer<std::uint8_t>("a record's kind"));
  return {op, in.integer<std::uint64_t>("a record's length")};
}

Bytes unpack(ByteReader in) {
  const ByteReader chunk = in;
  ByteView packed;
  const ChunkHead head = get_chunk(in, packed);
  Bytes records = decompress(packed, head.compression, head.uncompressed_bytes, chunk);
  if (head.uncompressed_crc != 0 && head.uncompressed_crc != crc32_of(records))
    chunk.fail("the chunk's checksum does not match its records");
  return records;
}

MessageHead LoadedRegion::message(std::size_t i, std::string_view path, ByteView& data) const {
  ByteReader in(ByteView(records).subspan(static_cast<std::size_t>(messages[i].second)), path,
                origin, true);
  ByteReader body = in.part(get_record_head(in).length, "a message");
  const MessageHead head = get_message(body);
  data = body.rest();
  return head;
}

LoadedRegion load(const InputFile& file, const Region& region) {
  LoadedRegion loaded;
  loaded.origin = region.offset;
  Bytes bytes = file.read(region.offset, region.length);
  if (!region.chunk) {
    loaded.records = std::move(bytes);
  } else {
    ByteReader in(ByteView(bytes).subspan(record_head_bytes), file.path(), region.offset);
    loaded.records = region.truncated ? unpack_start(in) : unpack(in);
  }
  index_messages(loaded, file.path(), region.truncated);
  return loaded;
}

std::uint64_t next_valid_record(const InputFile& file, std::uint64_t from) {
  constexpr std::uint64_t window = 1u << 16;  // bytes per read, chosen
  for (std::uint64_t base = from; base < file.size(); base += window) {
    const Bytes bytes = file.read(base, std::min(window, file.size() - base));
    for (std::uint64_t i = 0; i < bytes.size(); ++i) {
      const Op op = static_cast<Op>(bytes[i]);
      if (op != Op::schema && op != Op::channel && op != Op::chunk && op != Op::attachment)
        continue;
      if (is_valid_at(file, base + i)) return base + i;
    }
  }
  return file.size();
}

}  // namespace recording
