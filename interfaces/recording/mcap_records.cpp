#include "interfaces/recording/mcap_records.hpp"

#include <zlib.h>

namespace recording {
namespace {

void put_map(Bytes& out, const TextMap& map) {
  const std::size_t start = out.size();
  put(out, std::uint32_t{0});
  for (const auto& [key, value] : map)
    put(out, std::string_view(key)), put(out, std::string_view(value));
  Bytes length;
  put(length, static_cast<std::uint32_t>(out.size() - start - 4));
  std::copy(length.begin(), length.end(), out.begin() + static_cast<std::ptrdiff_t>(start));
}

TextMap get_map(ByteReader& in) {
  TextMap map;
  ByteReader entries = in.part(in.integer<std::uint32_t>("a map's length"), "a map");
  while (!entries.empty()) {
    std::string key = entries.characters("a map's key");
    map[std::move(key)] = entries.characters("a map's value");
  }
  return map;
}

void put_attachment_names(Bytes& out, const Attachment& attachment) {
  put(out, std::string_view(attachment.name));
  put(out, std::string_view(attachment.media_type));
}

}  // namespace

std::size_t begin_record(Bytes& out, Op op) {
  const std::size_t start = out.size();
  out.push_back(static_cast<std::byte>(op));
  put(out, std::uint64_t{0});
  return start;
}

void end_record(Bytes& out, std::size_t start) {
  Bytes length;
  put(length, static_cast<std::uint64_t>(out.size() - start - record_head_bytes));
  std::copy(length.begin(), length.end(), out.begin() + static_cast<std::ptrdiff_t>(start) + 1);
}

void put_schema(Bytes& out, const Schema& schema) {
  const auto start = begin_record(out, Op::schema);
  put(out, schema.id);
  put(out, std::string_view(schema.name));
  put(out, std::string_view(schema.encoding));
  put(out, std::string_view(schema.data));
  end_record(out, start);
}

Schema get_schema(ByteReader& in) {
  Schema schema;
  schema.id = in.integer<std::uint16_t>("a schema's id");
  if (schema.id == 0) in.fail("a schema has the id 0, which means none");
  schema.name = in.characters("a schema's name");
  schema.encoding = in.characters("a schema's encoding");
  schema.data = in.characters("a schema's text");
  return schema;
}

void put_channel(Bytes& out, const Channel& channel) {
  const auto start = begin_record(out, Op::channel);
  put(out, channel.id);
  put(out, channel.schema_id);
  put(out, std::string_view(channel.topic));
  put(out, std::string_view(channel.message_encoding));
  put_map(out, channel.metadata);
  end_record(out, start);
}

Channel get_channel(ByteReader& in) {
  Channel channel;
  channel.id = in.integer<std::uint16_t>("a channel's id");
  channel.schema_id = in.integer<std::uint16_t>("a channel's schema");
  channel.topic = in.characters("a channel's topic");
  channel.message_encoding = in.characters("a channel's encoding");
  channel.metadata = get_map(in);
  return channel;
}

void put_message(Bytes& out, const MessageHead& head, ByteView data) {
  const auto start = begin_record(out, Op::message);
  put(out, head.channel_id);
  put(out, head.sequence);
  put(out, head.log_time_ns);
  put(out, head.publish_time_ns);
  put(out, data);
  end_record(out, start);
}

MessageHead get_message(ByteReader& in) {
  MessageHead head;
  head.channel_id = in.integer<std::uint16_t>("a message's channel");
  head.sequence = in.integer<std::uint32_t>("a message's sequence");
  head.log_time_ns = in.integer<std::uint64_t>("a message's log time");
  head.publish_time_ns = in.integer<std::uint64_t>("a message's publish time");
  return head;
}

void put_chunk(Bytes& out, const ChunkHead& head, ByteView records) {
  const auto start = begin_record(out, Op::chunk);
  put(out, head.start_ns);
  put(out, head.end_ns);
  put(out, head.uncompressed_bytes);
  put(out, head.uncompressed_crc);
  put(out, std::string_view(head.compression));
  put(out, static_cast<std::uint64_t>(records.size()));
  put(out, records);
  end_record(out, start);
}

ChunkHead get_chunk(ByteReader& in, ByteView& records) {
  ChunkHead head;
  head.start_ns = in.integer<std::uint64_t>("a chunk's start time");
  head.end_ns = in.integer<std::uint64_t>("a chunk's end time");
  head.uncompressed_bytes = in.integer<std::uint64_t>("a chunk's size");
  head.uncompressed_crc = in.integer<std::uint32_t>("a chunk's checksum");
  head.compression = in.characters("a chunk's compression");
  records =
      in.take(in.integer<std::uint64_t>("the length of a chunk's records"), "a chunk's records");
  return head;
}

void put_message_index(Bytes& out, std::uint16_t channel, const MessageIndex& index) {
  const auto start = begin_record(out, Op::message_index);
  put(out, channel);
  put(out, static_cast<std::uint32_t>(index.size() * 16));
  for (const auto& [time_ns, offset] : index) put(out, time_ns), put(out, offset);
  end_record(out, start);
}

void put_chunk_index(Bytes& out, const ChunkIndex& index) {
  const auto start = begin_record(out, Op::chunk_index);
  put(out, index.head.start_ns);
  put(out, index.head.end_ns);
  put(out, index.offset);
  put(out, index.length);
  put(out, static_cast<std::uint32_t>(index.index_offsets.size() * 10));
  for (const auto& [channel, offset] : index.index_offsets) put(out, channel), put(out, offset);
  put(out, index.index_length);
  put(out, std::string_view(index.head.compression));
  put(out, index.compressed_bytes);
  put(out, index.head.uncompressed_bytes);
  end_record(out, start);
}

void put_attachment(Bytes& out, const Attachment& attachment) {
  const auto start = begin_record(out, Op::attachment);
  put(out, attachment.log_time_ns);
  put(out, attachment.create_time_ns);
  put_attachment_names(out, attachment);
  put(out, static_cast<std::uint64_t>(attachment.data.size()));
  put(out, view(attachment.data));
  put(out, crc32_of(ByteView(out).subspan(start + record_head_bytes)));
  end_record(out, start);
}

Attachment get_attachment(ByteReader& in) {
  ByteReader body = in;
  Attachment attachment;
  attachment.log_time_ns = in.integer<std::uint64_t>("an attachment's log time");
  attachment.create_time_ns = in.integer<std::uint64_t>("an attachment's creation time");
  attachment.name = in.characters("an attachment's name");
  attachment.media_type = in.characters("an attachment's media type");
  const ByteView data =
      in.take(in.integer<std::uint64_t>("an attachment's length"), "an attachment");
  const ByteView checksummed_bytes = body.take(in.position() - body.position(), "an attachment");
  const auto crc = in.integer<std::uint32_t>("an attachment's checksum");
  if (crc != 0 && crc != crc32_of(checksummed_bytes))
    body.fail("the checksum of the attachment \"" + attachment.name + "\" does not match");
  attachment.data = text(data);
  return attachment;
}

void put_attachment_index(Bytes& out, const AttachmentIndex& index, const Attachment& attachment) {
  const auto start = begin_record(out, Op::attachment_index);
  put(out, index.offset);
  put(out, index.length);
  put(out, attachment.log_time_ns);
  put(out, attachment.create_time_ns);
  put(out, index.data_bytes);
  put_attachment_names(out, attachment);
  end_record(out, start);
}

void put_metadata(Bytes& out, const Metadata& metadata) {
  const auto start = begin_record(out, Op::metadata);
  put(out, std::string_view(metadata.name));
  put_map(out, metadata.values);
  end_record(out, start);
}

Metadata get_metadata(ByteReader& in) {
  Metadata metadata;
  metadata.name = in.characters("a metadata record's name");
  metadata.values = get_map(in);
  return metadata;
}

std::uint32_t crc32_of(ByteView bytes, std::uint32_t initial_crc) {
  if (bytes.empty()) return initial_crc;  // zlib resets the checksum for a null pointer
  return static_cast<std::uint32_t>(
      crc32_z(initial_crc, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

}  // namespace recording
