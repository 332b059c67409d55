#include "interfaces/recording/mcap_reader.hpp"

#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <random>

#include "interfaces/recording/compression.hpp"
#include "tests/interfaces/recording/support.hpp"

using namespace recording;

namespace {

/// A file of individually encoded records, as another program may write it.
struct EncodedFile {
  Bytes bytes;
  EncodedFile() { put(bytes, std::as_bytes(std::span(magic))); }
  void channel(std::uint16_t id, std::uint16_t schema = 0) {
    put_channel(bytes, {id, schema, "t" + std::to_string(id), "cdr", {}});
  }
  void message(Bytes& out, std::uint64_t time_ns, const std::string& what, std::uint32_t n = 0) {
    put_message(out, {1, n, time_ns, time_ns}, view(what));
  }
  void chunk(const Bytes& records, ChunkHead head = {}) {
    head.uncompressed_bytes = head.uncompressed_bytes ? head.uncompressed_bytes : records.size();
    put_chunk(bytes, head, records);
  }
  void save(const std::string& path) const { test::write_file(path, std::string(text(bytes))); }
};

}  // namespace

TEST_CASE("written messages are read back with topics, times and attachment") {
  const test::Folder folder;
  const auto compression = GENERATE(Compression::none, Compression::zstd);
  test::small_recording(folder / "a.mcap", {.compression = compression, .chunk_bytes = 100}, 9);
  const McapReader reader(folder / "a.mcap");
  CHECK(reader.complete());
  CHECK(reader.truncation().empty());
  REQUIRE(reader.channels().size() == 2);
  CHECK(reader.channels().at(1).topic == "first");
  CHECK(reader.channels().at(1).metadata.at("writer") == "a");
  CHECK(reader.schemas().at(1).data == "string data\n");
  REQUIRE(reader.attachments().size() == 1);
  CHECK(reader.attachments()[0].name == "robot.xml");
  CHECK(reader.attachments()[0].data == "<robot name=\"rig\"/>");
  int i = 0;
  reader.for_each([&](const Message& message) {
    CHECK(text(message.data) == "message " + std::to_string(i));
    CHECK(message.log_time_ns == static_cast<std::uint64_t>(1000 + i * 10));
    CHECK(message.publish_time_ns == message.log_time_ns - 3);
    CHECK(message.channel.topic == (i % 2 ? "second" : "first"));
    ++i;
  });
  CHECK(i == 9);
}

TEST_CASE("messages are read in the order of log times even when chunks overlap") {
  const test::Folder folder;
  {
    McapWriter writer(folder / "a.mcap", {.chunk_bytes = 90});
    const auto channel = writer.add_channel("t", "cdr", 0);
    std::mt19937 random(7);
    for (int i = 0; i < 200; ++i)
      writer.write(channel, 0, random() % 50, 0, view(std::to_string(i)));
  }
  std::uint64_t last_time_ns = 0;
  int last_number = -1, count = 0;
  McapReader(folder / "a.mcap").for_each([&](const Message& message) {
    const int number = std::stoi(std::string(text(message.data)));
    CHECK(message.log_time_ns >= last_time_ns);
    if (message.log_time_ns == last_time_ns) CHECK(number > last_number);
    last_time_ns = message.log_time_ns;
    last_number = number;
    ++count;
  });
  CHECK(count == 200);
}

TEST_CASE("messages outside chunks and definitions inside chunks are read") {
  const test::Folder folder;
  EncodedFile file;
  file.channel(1);
  file.message(file.bytes, 30, "outside, later");
  file.message(file.bytes, 10, "outside, earlier");
  Bytes chunk_records;
  put_schema(chunk_records, {5, "s", "ros2msg", "bool b"});
  put_channel(chunk_records, {2, 5, "inner", "cdr", {}});
  file.message(chunk_records, 20, "in a chunk");
  file.chunk(chunk_records);
  file.save(folder / "a.mcap");
  const McapReader reader(folder / "a.mcap");
  CHECK(test::texts(reader) ==
        std::vector<std::string>{"outside, earlier", "in a chunk", "outside, later"});
  CHECK(reader.channels().at(2).topic == "inner");
}

TEST_CASE("skipped sequence numbers of a channel are counted; a restart is not counted as loss") {
  const test::Folder folder;
  EncodedFile file;
  file.channel(1);
  for (const std::uint32_t n : {5u, 6u, 9u, 10u, 0u, 1u, 3u}) file.message(file.bytes, n, "x", n);
  file.save(folder / "a.mcap");
  const auto statistics = McapReader(folder / "a.mcap").statistics().at(1);
  CHECK(statistics.missing == 3);
  CHECK(statistics.restarts == 1);
  CHECK(statistics.messages == 7);
}

TEST_CASE("an overflow of the 32-bit sequence number is not counted as a gap") {
  ChannelStatistics statistics;
  statistics.count({1, 0xffff'fffe, 0, 0});
  statistics.count({1, 0xffff'ffff, 0, 0});
  statistics.count({1, 1, 0, 0});
  CHECK(statistics.missing == 1);
  CHECK(statistics.restarts == 0);
}

TEST_CASE("a missing file, an empty file, a folder and another format are rejected with the name") {
  const test::Folder folder;
  test::write_file(folder / "text", "time_s,flexor.mode\n");
  test::write_file(folder / "empty", "");
  CHECK_THROWS_WITH(McapReader(folder / "text"),
                    Catch::Contains("byte 0: this is not an MCAP file"));
  CHECK_THROWS_WITH(McapReader(folder / "empty"), Catch::Contains("this is not an MCAP file"));
  CHECK_THROWS_WITH(McapReader(folder / "missing"), Catch::Contains("No such file"));
  CHECK_THROWS_WITH(McapReader(folder / "."), Catch::Contains("is not a file"));
}

TEST_CASE("damage is rejected with its byte position and the remedy") {
  const test::Folder folder;
  const std::string path = folder / "a.mcap";
  EncodedFile file;
  Bytes records;
  std::string what;
  SECTION("a wrong checksum") {
    file.channel(1);
    file.message(records, 1, "x");
    file.chunk(records, {.uncompressed_crc = 1});
    what = "the chunk's checksum does not match";
  }
  SECTION("a chunk with an unsupported compression") {
    file.chunk(records, {.uncompressed_bytes = 1, .compression = "lz4"});
    what = "compressed with \"lz4\"";
  }
  SECTION("a chunk with a wrong size") {
    file.chunk(records, {.uncompressed_bytes = std::uint64_t{1} << 60});
    what = "declares 1152921504606846976 bytes";
  }
  SECTION("a compressed chunk with a wrong size") {
    file.chunk(compress_zstd(view("abc")),
               {.uncompressed_bytes = std::uint64_t{1} << 60, .compression = "zstd"});
    what = "at most 268435456 are accepted";
  }
  SECTION("a zstd frame of another size") {
    file.chunk(compress_zstd(view("abc")), {.uncompressed_bytes = 4, .compression = "zstd"});
    what = "zstd frame differ";
  }
  SECTION("data that is not zstd") {
    file.chunk(Bytes(20), {.uncompressed_bytes = 4, .compression = "zstd"});
    what = "zstd";
  }
  SECTION("a record in a chunk that is longer than the chunk") {
    file.channel(1);
    file.message(records, 1, "x");
    records[1] = std::byte{200};
    file.chunk(records);
    what = "a record in a chunk needs 200 bytes";
  }
  SECTION("a message of a channel that was not defined") {
    file.message(file.bytes, 1, "x");
    what = "channel 1, which was not defined";
  }
  SECTION("a channel of a schema that was not defined") {
    file.channel(1, 3);
    what = "needs schema 3";
  }
  SECTION("a channel defined twice") {
    file.channel(1);
    put_channel(file.bytes, {1, 0, "other", "cdr", {}});
    what = "channel 1 is defined twice";
  }
  SECTION("a schema defined twice") {
    put_schema(file.bytes, {1, "a", "ros2msg", ""});
    put_schema(file.bytes, {1, "b", "ros2msg", ""});
    what = "schema 1 is defined twice";
  }
  SECTION("a schema without id") {
    put_schema(file.bytes, {0, "a", "ros2msg", ""});
    what = "id 0";
  }
  SECTION("a message too short for its head") {
    const auto start = begin_record(file.bytes, Op::message);
    end_record(file.bytes, start);
    what = "needs 2 bytes, its record has 0 left";
  }
  SECTION("text longer than its record") {
    const auto start = begin_record(file.bytes, Op::metadata);
    put(file.bytes, std::uint32_t{0xffff'ffff});
    end_record(file.bytes, start);
    what = "needs 4294967295 bytes";
  }
  SECTION("a changed attachment") {
    put_attachment(file.bytes, {0, 0, "robot.xml", "", "<robot/>"});
    file.bytes[file.bytes.size() - 6] ^= std::byte{1};
    what = "the attachment \"robot.xml\" does not match";
  }
  SECTION("a record of kind 0") {
    file.bytes.resize(file.bytes.size() + 20);
    what = "kind 0";
  }
  file.save(path);
  CHECK_THROWS_WITH(McapReader(path), Catch::StartsWith(path + ": byte ") &&
                                          Catch::Contains(what) &&
                                          Catch::Contains("erp log recover " + path));
}

TEST_CASE("a small file that unpacks to more memory than there is, and a pipe, are rejected") {
  const test::Folder folder;
  {
    McapWriter writer(folder / "bomb.mcap");
    const auto channel = writer.add_channel("t", "cdr", 0);
    const std::string zeros(64 << 20, '\0');
    for (std::uint64_t k = 1; k <= 12; ++k)
      writer.write(channel, 0, k, k, std::as_bytes(std::span(zeros)));
    writer.close();
  }
  CHECK(std::filesystem::file_size(folder / "bomb.mcap") < 400'000);
  CHECK_THROWS_WITH(McapReader(folder / "bomb.mcap"), Catch::Contains("more than 1000 times"));
  const std::string pipe = folder / "pipe.mcap";
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  CHECK_THROWS_WITH(McapReader(pipe), Catch::Contains("is not a file"));
}
