#include <catch2/catch.hpp>
#include <random>

#include "interfaces/recording/mcap_reader.hpp"
#include "tests/interfaces/recording/support.hpp"

using namespace recording;

TEST_CASE("a changed byte anywhere in a recording is detected or changes no message") {
  const test::Folder folder;
  const std::string good = test::small_recording(folder / "good.mcap", {.chunk_bytes = 100}, 6);
  const auto expected = test::texts(McapReader(folder / "good.mcap"));
  int detected = 0;
  for (std::size_t i = 0; i < good.size(); ++i) {
    std::string bad = good;
    bad[i] = static_cast<char>(bad[i] ^ 0x41);
    test::write_file(folder / "bad.mcap", bad);
    try {
      const McapReader reader(folder / "bad.mcap");
      if (reader.complete()) CHECK(test::texts(reader) == expected);
      else ++detected;
    } catch (const RecordingError&) {
      ++detected;
    }
  }
  // Changes of the last numbers in the footer and of unused record types are not detected; changes
  // of data bytes are all detected.
  constexpr int undetected_bytes = 40;
  CHECK(detected > static_cast<int>(good.size()) - undetected_bytes);
}

TEST_CASE(
    "reader and recover give the messages of the complete chunks of a recording truncated at any "
    "byte") {
  const test::Folder folder;
  const auto compression = GENERATE(Compression::none, Compression::zstd);
  const std::string complete_file = test::small_recording(
      folder / "whole.mcap", {.compression = compression, .chunk_bytes = 100}, 10);
  const McapReader all(folder / "whole.mcap");
  const auto expected = test::texts(all);
  for (std::size_t size = 1; size < complete_file.size(); ++size) {
    test::write_file(folder / "cut.mcap", complete_file.substr(0, size));
    std::size_t in_complete_chunks = 0;
    for (const Region& region : all.contents().regions)
      if (region.offset + region.length <= size) in_complete_chunks += region.messages;
    const McapReader reader(folder / "cut.mcap");
    const auto messages = test::texts(reader);
    CHECK_FALSE(reader.complete());
    CHECK(reader.truncation().find("cut.mcap: byte ") != std::string::npos);
    CHECK(messages.size() == in_complete_chunks);
    CHECK(std::equal(messages.begin(), messages.end(), expected.begin()));

    const Recovered recovered = recover(folder / "cut.mcap", folder / "repaired.mcap");
    const McapReader repaired(folder / "repaired.mcap");
    const auto recovered_messages = test::texts(repaired);
    CHECK(repaired.complete());
    CHECK(recovered_messages.size() == recovered.messages);
    CHECK(recovered_messages.size() >= in_complete_chunks);
    CHECK(std::equal(recovered_messages.begin(), recovered_messages.end(), expected.begin()));
    std::filesystem::remove(folder / "repaired.mcap");
  }
}

TEST_CASE("recover reads the messages at the start of a truncated chunk") {
  const test::Folder folder;
  const std::string complete_file =
      test::small_recording(folder / "a.mcap", {.compression = Compression::none}, 10);
  const Region chunk = McapReader(folder / "a.mcap").contents().regions.at(0);
  test::write_file(folder / "cut.mcap", complete_file.substr(0, chunk.offset + chunk.length - 5));
  CHECK(McapReader(folder / "cut.mcap").contents().messages == 0);
  CHECK(recover(folder / "cut.mcap", folder / "repaired.mcap").messages == 9);
}

TEST_CASE(
    "recover omits a damaged chunk and keeps the other messages, the attachment and the channels") {
  const test::Folder folder;
  std::string bytes = test::small_recording(folder / "a.mcap", {.chunk_bytes = 100}, 12);
  const McapReader good(folder / "a.mcap");
  const Region second = good.contents().regions.at(1);
  bytes[second.offset + second.length - 3] ^= 0x55;
  test::write_file(folder / "bad.mcap", bytes);
  CHECK_THROWS_AS(McapReader(folder / "bad.mcap"), RecordingError);
  const Recovered recovered = recover(folder / "bad.mcap", folder / "repaired.mcap");
  CHECK(recovered.messages == 12 - second.messages);
  CHECK(recovered.attachments == 1);
  CHECK(recovered.problems.size() == 2);  // the chunk, and the checksum over all data
  const McapReader repaired(folder / "repaired.mcap");
  CHECK(repaired.complete());
  CHECK(repaired.channels() == good.channels());
  CHECK(repaired.schemas() == good.schemas());
}

TEST_CASE("recover continues after a wrong length and reads damaged definitions from the summary") {
  const test::Folder folder;
  std::string bytes = test::small_recording(folder / "a.mcap", {.chunk_bytes = 100}, 12);
  const std::size_t attachment = bytes.find("robot.xml") - 4 - 16 - 9;
  REQUIRE(bytes[attachment] == 9);
  const auto damaged_record = GENERATE(0, 1, 2);
  if (damaged_record == 0) bytes[attachment + 3] = 0x7f;              // the attachment's length
  if (damaged_record == 1) bytes[bytes.find("first") - 10] = 0x7f;    // the channel's length
  if (damaged_record == 2) bytes[bytes.find("std_msgs") - 3] = 0x7f;  // the schema's name's length
  test::write_file(folder / "bad.mcap", bytes);
  const Recovered recovered = recover(folder / "bad.mcap", folder / "repaired.mcap");
  CHECK(recovered.messages == 12);
  CHECK_FALSE(recovered.problems.empty());
}

TEST_CASE("recover does not overwrite an existing file or its own input") {
  const test::Folder folder;
  const std::string bytes = test::small_recording(folder / "a.mcap", {}, 3);
  CHECK_THROWS_WITH(recover(folder / "a.mcap", folder / "a.mcap"),
                    Catch::Contains("the file exists already"));
  CHECK(test::read_file(folder / "a.mcap") == bytes);
}

TEST_CASE("random damage crashes neither the reader nor recover") {
  const test::Folder folder;
  const auto compression = GENERATE(Compression::none, Compression::zstd);
  const std::string good = test::small_recording(
      folder / "good.mcap", {.compression = compression, .chunk_bytes = 150}, 12);
  std::mt19937 random(20240229);
  const auto random_below = [&](std::size_t n) { return random() % n; };
  for (int round = 0; round < 1500; ++round) {
    std::string bad = good;
    for (std::size_t change = 0; change <= random_below(6); ++change) {
      const std::size_t position = random_below(bad.size());
      switch (random_below(4)) {
        case 0:
          bad[position] = static_cast<char>(random());
          break;
        case 1:
          bad.erase(position, random_below(40));
          break;
        case 2:
          bad.insert(position, good.substr(random_below(good.size()), random_below(60)));
          break;
        default:
          std::fill_n(bad.begin() + static_cast<std::ptrdiff_t>(position),
                      std::min<std::size_t>(8, bad.size() - position), '\xff');
      }
      if (bad.empty()) bad = "x";
    }
    test::write_file(folder / "bad.mcap", bad);
    try {
      test::texts(McapReader(folder / "bad.mcap"));
    } catch (const RecordingError&) {
    }
    try {
      recover(folder / "bad.mcap", folder / "repaired.mcap");
      CHECK(McapReader(folder / "repaired.mcap").complete());
    } catch (const RecordingError& error) {
      CHECK_THAT(error.what(), Catch::Contains("not an MCAP file"));
    }
    std::filesystem::remove(folder / "repaired.mcap");
  }
}
