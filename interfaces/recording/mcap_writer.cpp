#include "interfaces/recording/mcap_writer.hpp"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <utility>

#include "interfaces/recording/compression.hpp"

namespace recording {
namespace {

/// Stamps of two clocks (simulated and wall time) may share a recording. A larger difference of two
/// stamps is taken for a difference of clocks, not for the duration of a chunk. Chosen: one hour.
constexpr std::uint64_t max_open_span_ns = 3'600'000'000'000;
constexpr std::uint16_t max_ids = std::numeric_limits<std::uint16_t>::max();

void put_summary_offset(Bytes& out, Op op, std::uint64_t start, std::uint64_t length) {
  if (length == 0) return;
  const auto record = begin_record(out, Op::summary_offset);
  put(out, static_cast<std::uint8_t>(op));
  put(out, start);
  put(out, length);
  end_record(out, record);
}

}  // namespace

McapWriter::McapWriter(std::string path, McapOptions options)
    : options_(options), file_(std::move(path), options.replace) {
  Bytes out;
  put(out, std::as_bytes(std::span(magic)));
  const auto start = begin_record(out, Op::header);
  put(out, std::string_view(""));
  put(out, std::string_view("erp " ERP_VERSION));
  end_record(out, start);
  try {
    append(out);
  } catch (const WriteError&) {
    file_.remove();
    throw;
  }
}

McapWriter::~McapWriter() {
  if (failed_ || !file_.is_open()) return;
  try {
    close();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
  }
}

void McapWriter::append(const Bytes& bytes) {
  if (!file_.is_open()) throw RecordingError(path() + ": the recording is closed; open a new one");
  if (failed_)
    throw RecordingError(path() + ": an earlier write failed; the recording ends before it");
  failed_ = !options_.continue_after_failure;
  file_.append(bytes);
  failed_ = false;
  failure_.clear();
}

void McapWriter::append_or_hold(const Bytes& record) {
  put(held_, record);
  try {
    append(held_);
    held_.clear();
  } catch (const WriteError& error) {
    if (!options_.continue_after_failure) throw;
    failure_ = error.what();
  }
}

std::uint16_t McapWriter::add_schema(std::string name, std::string encoding, std::string data) {
  if (schema_count_ == max_ids) throw RecordingError(path() + ": more than 65535 types");
  const Schema schema{static_cast<std::uint16_t>(schema_count_ + 1), std::move(name),
                      std::move(encoding), std::move(data)};
  Bytes record;
  put_schema(record, schema);
  append_or_hold(record);
  put(schema_records_, record);
  return schema_count_ = schema.id;
}

std::uint16_t McapWriter::add_channel(std::string topic, std::string message_encoding,
                                      std::uint16_t schema_id, TextMap metadata) {
  if (schema_id > schema_count_)
    throw std::invalid_argument("no schema has the id " + std::to_string(schema_id));
  if (channel_count_ == max_ids) throw RecordingError(path() + ": more than 65535 writers");
  const Channel channel{static_cast<std::uint16_t>(channel_count_ + 1), schema_id, std::move(topic),
                        std::move(message_encoding), std::move(metadata)};
  Bytes record;
  put_channel(record, channel);
  append_or_hold(record);
  put(channel_records_, record);
  return channel_count_ = channel.id;
}

void McapWriter::write(std::uint16_t channel, std::uint32_t sequence, std::uint64_t log_time_ns,
                       std::uint64_t publish_time_ns, ByteView data) {
  if (channel == 0 || channel > channel_count_)
    throw std::invalid_argument("no channel has the id " + std::to_string(channel));
  if (failed_ || !file_.is_open()) append({});
  const bool first = chunk_.records.empty();
  if (first) chunk_.first_ns = log_time_ns;
  chunk_.start_ns = first ? log_time_ns : std::min(chunk_.start_ns, log_time_ns);
  chunk_.end_ns = first ? log_time_ns : std::max(chunk_.end_ns, log_time_ns);
  start_ns_ = messages_ ? std::min(start_ns_, log_time_ns) : log_time_ns;
  end_ns_ = std::max(end_ns_, log_time_ns);
  chunk_.index[channel].emplace_back(log_time_ns, chunk_.records.size());
  put_message(chunk_.records, {channel, sequence, log_time_ns, publish_time_ns}, data);
  ++messages_;
  ++channel_messages_[channel];
  const std::uint64_t first_ns = chunk_.first_ns;
  const std::uint64_t span_ns =
      log_time_ns > first_ns ? log_time_ns - first_ns : first_ns - log_time_ns;
  const bool long_enough = span_ns >= options_.chunk_span_ns && span_ns < max_open_span_ns;
  if (long_enough || chunk_.records.size() >= options_.chunk_bytes) close_chunk();
}

void McapWriter::close_chunk() {
  if (chunk_.records.empty()) return;
  const bool zstd = options_.compression == Compression::zstd;
  const Bytes compressed = zstd ? compress_zstd(chunk_.records) : Bytes{};
  const Bytes& records = zstd ? compressed : chunk_.records;
  ChunkIndex index;
  index.head = {chunk_.start_ns, chunk_.end_ns, chunk_.records.size(), crc32_of(chunk_.records),
                zstd ? "zstd" : ""};
  Bytes out = held_;
  index.offset = file_.size() + held_.size();
  put_chunk(out, index.head, records);
  index.length = out.size() - held_.size();
  index.compressed_bytes = records.size();
  for (auto& [channel, messages] : chunk_.index) {
    std::stable_sort(messages.begin(), messages.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    index.index_offsets[channel] = file_.size() + out.size();
    put_message_index(out, channel, messages);
  }
  index.index_length = out.size() - held_.size() - index.length;
  try {
    append(out);
  } catch (const WriteError& error) {
    if (!options_.continue_after_failure) throw;
    return drop_chunk(error);
  }
  held_.clear();
  chunks_.push_back(std::move(index));
  chunk_ = {};
}

void McapWriter::drop_chunk(const WriteError& error) {
  failure_ = error.what();
  if (lost_.count == 0) lost_.first_ns = chunk_.start_ns;
  lost_.last_ns = std::max(lost_.last_ns, chunk_.end_ns);
  for (const auto& [channel, messages] : chunk_.index) {
    lost_.count += messages.size();
    messages_ -= messages.size();
    channel_messages_[channel] -= messages.size();
  }
  chunk_ = {};
}

void McapWriter::attach(std::string name, std::string media_type, std::string data) {
  attach(Attachment{0, 0, std::move(name), std::move(media_type), std::move(data)});
}

void McapWriter::attach(const Attachment& attachment) {
  Bytes record;
  put_attachment(record, attachment);
  const AttachmentIndex index{file_.size(), record.size(), attachment.data.size()};
  append(record);
  put_attachment_index(attachment_records_, index, attachment);
  ++attachment_count_;
}

void McapWriter::add_metadata(const Metadata& metadata) {
  Bytes record;
  put_metadata(record, metadata);
  const std::uint64_t offset = file_.size();
  append(record);
  const auto start = begin_record(metadata_records_, Op::metadata_index);
  put(metadata_records_, offset);
  put(metadata_records_, static_cast<std::uint64_t>(record.size()));
  put(metadata_records_, std::string_view(metadata.name));
  end_record(metadata_records_, start);
  ++metadata_count_;
}

void McapWriter::flush() {
  close_chunk();
  if (!failure_.empty()) return;
  append({});
  try {
    file_.sync();
  } catch (const WriteError& error) {
    if (!options_.continue_after_failure) throw;
    failure_ = error.what();
  }
}

void McapWriter::put_statistics(Bytes& out) const {
  const auto start = begin_record(out, Op::statistics);
  put(out, messages_);
  put(out, schema_count_);
  put(out, static_cast<std::uint32_t>(channel_count_));
  put(out, attachment_count_);
  put(out, metadata_count_);
  put(out, static_cast<std::uint32_t>(chunks_.size()));
  put(out, start_ns_);
  put(out, end_ns_);
  put(out, static_cast<std::uint32_t>(channel_messages_.size() * 10));
  for (const auto& [channel, count] : channel_messages_) put(out, channel), put(out, count);
  end_record(out, start);
}

void McapWriter::put_summary(Bytes& out) {
  const std::uint64_t summary_start = file_.size();
  Bytes offsets;
  const auto group = [&](Op op, const auto& fill) {
    const std::size_t start = out.size();
    fill();
    put_summary_offset(offsets, op, summary_start + start, out.size() - start);
  };
  group(Op::schema, [&] { put(out, schema_records_); });
  group(Op::channel, [&] { put(out, channel_records_); });
  group(Op::statistics, [&] { put_statistics(out); });
  group(Op::chunk_index, [&] {
    for (const auto& chunk : chunks_) put_chunk_index(out, chunk);
  });
  group(Op::attachment_index, [&] { put(out, attachment_records_); });
  group(Op::metadata_index, [&] { put(out, metadata_records_); });
  const std::uint64_t offsets_start = summary_start + out.size();
  put(out, offsets);
  const auto footer = begin_record(out, Op::footer);
  put(out, summary_start);
  put(out, offsets_start);
  put(out, std::uint32_t{0});
  end_record(out, footer);
  const std::uint32_t crc = crc32_of(ByteView(out).first(out.size() - 4));
  out.resize(out.size() - 4);
  put(out, crc);
}

void McapWriter::close() {
  if (!file_.is_open()) return;
  close_chunk();
  append(std::exchange(held_, {}));
  Bytes end;
  const auto start = begin_record(end, Op::data_end);
  put(end, file_.crc());
  end_record(end, start);
  append(end);
  Bytes out;
  put_summary(out);
  put(out, std::as_bytes(std::span(magic)));
  append(out);
  failed_ = true;  // until the data is on the disk
  file_.close();
  failed_ = false;
}

}  // namespace recording
