#include "interfaces/recording/mcap_reader.hpp"

#include <catch2/catch.hpp>
#include <random>

#include "interfaces/recording/compression.hpp"
#include "tests/interfaces/recording/support.hpp"

using namespace recording;

namespace {

std::vector<std::string> texts(const McapReader& reader) {
  std::vector<std::string> found;
  reader.for_each([&](const Message& message) { found.emplace_back(text(message.data)); });
  return found;
}

/// A file of records made by hand, as another program might write them.
struct HandMade {
  Bytes bytes;
  HandMade() { put(bytes, std::as_bytes(std::span(magic))); }
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

TEST_CASE("what was written is read back, with its topics, times and attachment") {
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

TEST_CASE("messages come in the order of log times even when chunks overlap") {
  const test::Folder folder;
  {
    McapWriter writer(folder / "a.mcap", {.chunk_bytes = 90});
    const auto channel = writer.add_channel("t", "cdr", 0);
    std::mt19937 random(7);
    for (int i = 0; i < 200; ++i)
      writer.write(channel, 0, random() % 50, 0, view(std::to_string(i)));
  }
  std::uint64_t last = 0;
  int last_number = -1, count = 0;
  McapReader(folder / "a.mcap").for_each([&](const Message& message) {
    const int number = std::stoi(std::string(text(message.data)));
    CHECK(message.log_time_ns >= last);
    if (message.log_time_ns == last) CHECK(number > last_number);
    last = message.log_time_ns;
    last_number = number;
    ++count;
  });
  CHECK(count == 200);
}

TEST_CASE("messages outside of chunks and definitions inside of them are read too") {
  const test::Folder folder;
  HandMade file;
  file.channel(1);
  file.message(file.bytes, 30, "loose late");
  file.message(file.bytes, 10, "loose early");
  Bytes inside;
  put_schema(inside, {5, "s", "ros2msg", "bool b"});
  put_channel(inside, {2, 5, "inner", "cdr", {}});
  file.message(inside, 20, "in a chunk");
  file.chunk(inside);
  file.save(folder / "a.mcap");
  const McapReader reader(folder / "a.mcap");
  CHECK(texts(reader) == std::vector<std::string>{"loose early", "in a chunk", "loose late"});
  CHECK(reader.channels().at(2).topic == "inner");
}

TEST_CASE("skipped numbers are counted per channel, a restart is no loss") {
  const test::Folder folder;
  HandMade file;
  file.channel(1);
  for (const std::uint32_t n : {5u, 6u, 9u, 10u, 0u, 1u, 3u}) file.message(file.bytes, n, "x", n);
  file.save(folder / "a.mcap");
  const auto statistics = McapReader(folder / "a.mcap").statistics().at(1);
  CHECK(statistics.missing == 3);
  CHECK(statistics.restarts == 1);
  CHECK(statistics.messages == 7);
}

TEST_CASE("the 32-bit number may run over without a gap") {
  ChannelStatistics statistics;
  statistics.count({1, 0xffff'fffe, 0, 0});
  statistics.count({1, 0xffff'ffff, 0, 0});
  statistics.count({1, 1, 0, 0});
  CHECK(statistics.missing == 1);
  CHECK(statistics.restarts == 0);
}

TEST_CASE("a file that is none, empty or a folder is refused with its name") {
  const test::Folder folder;
  test::write_file(folder / "text", "time_s,flexor.mode\n");
  test::write_file(folder / "empty", "");
  CHECK_THROWS_WITH(McapReader(folder / "text"), Catch::Contains("byte 0: this is not an MCAP file"));
  CHECK_THROWS_WITH(McapReader(folder / "empty"), Catch::Contains("this is not an MCAP file"));
  CHECK_THROWS_WITH(McapReader(folder / "missing"), Catch::Contains("No such file"));
  CHECK_THROWS_WITH(McapReader(folder / "."), Catch::Contains("is not a file"));
}

TEST_CASE("damage is refused with the byte where it is and what to do") {
  const test::Folder folder;
  const std::string path = folder / "a.mcap";
  HandMade file;
  Bytes records;
  std::string what;
  SECTION("a lying checksum") {
    file.channel(1);
    file.message(records, 1, "x");
    file.chunk(records, {.uncompressed_crc = 1});
    what = "the chunk's checksum does not match";
  }
  SECTION("a chunk of a compression nobody knows") {
    file.chunk(records, {.uncompressed_bytes = 1, .compression = "lz4"});
    what = "compressed with \"lz4\"";
  }
  SECTION("a chunk that lies about its size") {
    file.chunk(records, {.uncompressed_bytes = std::uint64_t{1} << 60});
    what = "says it holds 1152921504606846976 bytes";
  }
  SECTION("a compressed chunk that lies about its size") {
    file.chunk(compress_zstd(view("abc")), {.uncompressed_bytes = std::uint64_t{1} << 60, .compression = "zstd"});
    what = "at most 268435456 are accepted";
  }
  SECTION("a zstd frame of another size") {
    file.chunk(compress_zstd(view("abc")), {.uncompressed_bytes = 4, .compression = "zstd"});
    what = "zstd frame differ";
  }
  SECTION("zstd that is none") {
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
  SECTION("an attachment that changed") {
    put_attachment(file.bytes, {0, 0, "robot.xml", "", "<robot/>"});
    file.bytes[file.bytes.size() - 6] ^= std::byte{1};
    what = "the attachment \"robot.xml\" does not match";
  }
  SECTION("a record of kind 0") {
    file.bytes.resize(file.bytes.size() + 20);
    what = "kind 0";
  }
  file.save(path);
  CHECK_THROWS_WITH(McapReader(path), Catch::StartsWith(path + ": byte ") && Catch::Contains(what) &&
                                          Catch::Contains("erp log recover " + path));
}

TEST_CASE("a changed byte anywhere in a whole recording is noticed or harmless") {
  const test::Folder folder;
  const std::string good = test::small_recording(folder / "good.mcap", {.chunk_bytes = 100}, 6);
  const auto expected = texts(McapReader(folder / "good.mcap"));
  int noticed = 0;
  for (std::size_t i = 0; i < good.size(); ++i) {
    std::string bad = good;
    bad[i] = static_cast<char>(bad[i] ^ 0x41);
    test::write_file(folder / "bad.mcap", bad);
    try {
      const McapReader reader(folder / "bad.mcap");
      if (reader.complete()) CHECK(texts(reader) == expected);
      else ++noticed;
    } catch (const RecordingError&) {
      ++noticed;
    }
  }
  // The footer's last numbers and kinds that nobody needs may change unnoticed; no data byte may.
  CHECK(noticed > static_cast<int>(good.size()) - 40);
}

TEST_CASE("cut at any byte, a recording gives the messages of its whole chunks and can be mended") {
  const test::Folder folder;
  const auto compression = GENERATE(Compression::none, Compression::zstd);
  const std::string whole = test::small_recording(
      folder / "whole.mcap", {.compression = compression, .chunk_bytes = 100}, 10);
  const McapReader all(folder / "whole.mcap");
  const auto expected = texts(all);
  for (std::size_t size = 1; size < whole.size(); ++size) {
    test::write_file(folder / "cut.mcap", whole.substr(0, size));
    std::size_t in_whole_chunks = 0;
    for (const Region& region : all.contents().regions)
      if (region.offset + region.length <= size) in_whole_chunks += region.messages;
    const McapReader reader(folder / "cut.mcap");
    const auto found = texts(reader);
    CHECK_FALSE(reader.complete());
    CHECK(reader.truncation().find("cut.mcap: byte ") != std::string::npos);
    CHECK(found.size() == in_whole_chunks);
    CHECK(std::equal(found.begin(), found.end(), expected.begin()));

    const Recovered recovered = recover(folder / "cut.mcap", folder / "mended.mcap");
    const McapReader mended(folder / "mended.mcap");
    const auto saved = texts(mended);
    CHECK(mended.complete());
    CHECK(saved.size() == recovered.messages);
    CHECK(saved.size() >= in_whole_chunks);
    CHECK(std::equal(saved.begin(), saved.end(), expected.begin()));
    std::filesystem::remove(folder / "mended.mcap");
  }
}

TEST_CASE("recover takes the messages at the start of a chunk that was cut") {
  const test::Folder folder;
  const std::string whole =
      test::small_recording(folder / "a.mcap", {.compression = Compression::none}, 10);
  const Region chunk = McapReader(folder / "a.mcap").contents().regions.at(0);
  test::write_file(folder / "cut.mcap", whole.substr(0, chunk.offset + chunk.length - 5));
  CHECK(McapReader(folder / "cut.mcap").contents().messages == 0);
  CHECK(recover(folder / "cut.mcap", folder / "mended.mcap").messages == 9);
}

TEST_CASE("recover steps over a damaged chunk and keeps the rest, attachment and numbers included") {
  const test::Folder folder;
  std::string bytes = test::small_recording(folder / "a.mcap", {.chunk_bytes = 100}, 12);
  const McapReader good(folder / "a.mcap");
  const Region second = good.contents().regions.at(1);
  bytes[second.offset + second.length - 3] ^= 0x55;
  test::write_file(folder / "bad.mcap", bytes);
  CHECK_THROWS_AS(McapReader(folder / "bad.mcap"), RecordingError);
  const Recovered recovered = recover(folder / "bad.mcap", folder / "mended.mcap");
  CHECK(recovered.messages == 12 - second.messages);
  CHECK(recovered.attachments == 1);
  CHECK(recovered.problems.size() == 2);  // the chunk, and the checksum over all data
  const McapReader mended(folder / "mended.mcap");
  CHECK(mended.complete());
  CHECK(mended.channels() == good.channels());
  CHECK(mended.schemas() == good.schemas());
}

TEST_CASE("recover finds its way again after a wrong length, and lost definitions in the summary") {
  const test::Folder folder;
  std::string bytes = test::small_recording(folder / "a.mcap", {.chunk_bytes = 100}, 12);
  const std::size_t attachment = bytes.find("robot.xml") - 4 - 16 - 9;
  REQUIRE(bytes[attachment] == 9);
  const auto victim = GENERATE(0, 1, 2);
  if (victim == 0) bytes[attachment + 3] = 0x7f;               // the attachment's length
  if (victim == 1) bytes[bytes.find("first") - 10] = 0x7f;     // the channel's length
  if (victim == 2) bytes[bytes.find("std_msgs") - 3] = 0x7f;   // the schema's name's length
  test::write_file(folder / "bad.mcap", bytes);
  const Recovered recovered = recover(folder / "bad.mcap", folder / "mended.mcap");
  CHECK(recovered.messages == 12);
  CHECK_FALSE(recovered.problems.empty());
}

TEST_CASE("recover does not write over a file, its own input least of all") {
  const test::Folder folder;
  const std::string bytes = test::small_recording(folder / "a.mcap", {}, 3);
  CHECK_THROWS_WITH(recover(folder / "a.mcap", folder / "a.mcap"),
                    Catch::Contains("there is a file already"));
  CHECK(test::read_file(folder / "a.mcap") == bytes);
}

TEST_CASE("random damage never crashes the reader nor recover") {
  const test::Folder folder;
  const auto compression = GENERATE(Compression::none, Compression::zstd);
  const std::string good = test::small_recording(
      folder / "good.mcap", {.compression = compression, .chunk_bytes = 150}, 12);
  std::mt19937 random(20240229);
  const auto below = [&](std::size_t n) { return random() % n; };
  for (int round = 0; round < 1500; ++round) {
    std::string bad = good;
    for (std::size_t hit = 0; hit <= below(6); ++hit) {
      const std::size_t at = below(bad.size());
      switch (below(4)) {
        case 0: bad[at] = static_cast<char>(random()); break;
        case 1: bad.erase(at, below(40)); break;
        case 2: bad.insert(at, good.substr(below(good.size()), below(60))); break;
        default: std::fill_n(bad.begin() + static_cast<std::ptrdiff_t>(at),
                             std::min<std::size_t>(8, bad.size() - at), '\xff');
      }
      if (bad.empty()) bad = "x";
    }
    test::write_file(folder / "bad.mcap", bad);
    try {
      texts(McapReader(folder / "bad.mcap"));
    } catch (const RecordingError&) {
    }
    try {
      recover(folder / "bad.mcap", folder / "mended.mcap");
      CHECK(McapReader(folder / "mended.mcap").complete());
    } catch (const RecordingError& error) {
      CHECK_THAT(error.what(), Catch::Contains("not an MCAP file"));
    }
    std::filesystem::remove(folder / "mended.mcap");
  }
}
