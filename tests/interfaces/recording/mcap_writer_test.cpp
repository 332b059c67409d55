#include "interfaces/recording/mcap_writer.hpp"

#include <sys/resource.h>
#include <zlib.h>

#include <catch2/catch.hpp>
#include <csignal>

#include "interfaces/recording/mcap_reader.hpp"
#include "tests/interfaces/recording/support.hpp"

using namespace recording;

namespace {

const std::string magic_text = "\x89MCAP0\r\n";

std::uint64_t u64(const std::string& bytes, std::size_t position) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < 8; ++i)
    value |= std::uint64_t{static_cast<unsigned char>(bytes.at(position + i))} << (8 * i);
  return value;
}
std::uint32_t u32(const std::string& bytes, std::size_t position) {
  return static_cast<std::uint32_t>(u64(bytes + std::string(4, '\0'), position));
}
std::uint32_t crc(const std::string& bytes) {
  return static_cast<std::uint32_t>(
      crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}

/// The kinds of the records between the two magics, with their positions.
std::vector<std::pair<int, std::size_t>> records(const std::string& bytes) {
  std::vector<std::pair<int, std::size_t>> kinds_at;
  for (std::size_t position = 8; position + 8 < bytes.size();
       position += 9 + u64(bytes, position + 1))
    kinds_at.emplace_back(bytes[position], position);
  return kinds_at;
}
std::size_t position_of(const std::string& bytes, int op) {
  for (const auto& [kind, position] : records(bytes))
    if (kind == op) return position;
  FAIL("no record of kind " << op);
  return 0;
}

}  // namespace

TEST_CASE("a recording starts and ends with MCAP's eight bytes and a header without profile") {
  const test::Folder folder;
  const std::string bytes = test::small_recording(folder / "a.mcap", {}, 4);
  CHECK(bytes.substr(0, 8) == magic_text);
  CHECK(bytes.substr(bytes.size() - 8) == magic_text);
  CHECK(bytes[8] == 1);
  CHECK(u32(bytes, 17) == 0);
  CHECK(bytes.substr(25, 4) == "erp ");
  CHECK(u32(bytes, 21) == u64(bytes, 9) - 8);
}

TEST_CASE("the records are in the order that the format requires") {
  const test::Folder folder;
  const std::string bytes = test::small_recording(folder / "a.mcap", {.chunk_bytes = 60}, 3);
  std::vector<int> kinds;
  for (const auto& [kind, position] : records(bytes)) kinds.push_back(kind);
  const std::vector<int> expected{1,  9,  3,  4,  4,       // header, attachment, schema, channels
                                  6,  7,  7,  6,  7,  15,  // two chunks with indexes, end of data
                                  3,  4,  4,  11, 8,  8,
                                  10,  // summary: … statistics, chunks, attachment
                                  14, 14, 14, 14, 14, 2};
  CHECK(kinds == expected);
}

TEST_CASE("data, summary, chunk and attachment have correct checksums") {
  const test::Folder folder;
  const std::string bytes =
      test::small_recording(folder / "a.mcap", {.compression = Compression::none}, 4);
  const std::size_t data_end = position_of(bytes, 15);
  CHECK(u32(bytes, data_end + 9) == crc(bytes.substr(0, data_end)));
  const std::size_t footer = position_of(bytes, 2), summary = u64(bytes, footer + 9);
  CHECK(summary == data_end + 13);
  CHECK(u32(bytes, footer + 25) == crc(bytes.substr(summary, footer + 25 - summary)));
  const std::size_t chunk = position_of(bytes, 6);
  CHECK(u32(bytes, chunk + 33) == crc(bytes.substr(chunk + 49, u64(bytes, chunk + 41))));
  const std::size_t attachment = position_of(bytes, 9), length = u64(bytes, attachment + 1);
  CHECK(u32(bytes, attachment + 9 + length - 4) == crc(bytes.substr(attachment + 9, length - 4)));
}

TEST_CASE("every summary offset and index points at its record") {
  const test::Folder folder;
  const std::string bytes = test::small_recording(folder / "a.mcap", {.chunk_bytes = 60}, 5);
  for (const auto& [kind, position] : records(bytes)) {
    if (kind == 14) {
      CHECK(bytes[u64(bytes, position + 10)] == bytes[position + 9]);
    }
    if (kind == 8) {
      const std::size_t chunk = u64(bytes, position + 25);
      CHECK(bytes[chunk] == 6);
      CHECK(u64(bytes, chunk + 1) + 9 == u64(bytes, position + 33));
      const std::size_t index = u64(bytes, position + 47);
      CHECK(bytes[index] == 7);
      CHECK(index >= chunk + u64(bytes, position + 33));
    }
    if (kind == 10) {
      CHECK(bytes[u64(bytes, position + 9)] == 9);
    }
  }
}

TEST_CASE("a chunk spans at most one second of log time") {
  const test::Folder folder;
  McapWriter writer(folder / "a.mcap");
  const auto channel = writer.add_channel("t", "cdr", 0);
  for (std::uint64_t i = 0; i < 40; ++i) writer.write(channel, 0, i * 100'000'000, 0, view("x"));
  writer.close();
  const McapReader reader(folder / "a.mcap");
  for (const auto& region : reader.contents().regions)
    CHECK(region.last_ns - region.first_ns <= 1'000'000'000);
  CHECK(reader.contents().chunks == 4);
}

TEST_CASE("two clocks in one recording do not lead to one chunk per message") {
  const test::Folder folder;
  McapWriter writer(folder / "a.mcap");
  const auto channel = writer.add_channel("t", "cdr", 0);
  for (std::uint64_t i = 0; i < 100; ++i)
    writer.write(channel, 0, i * 1'000'000 + (i % 2) * 1'700'000'000'000'000'000, 0, view("x"));
  writer.close();
  CHECK(McapReader(folder / "a.mcap").contents().chunks == 1);
}

TEST_CASE("a flushed message is in the file of a recording that was not closed") {
  const test::Folder folder;
  McapWriter writer(folder / "a.mcap");
  const auto channel = writer.add_channel("t", "cdr", 0);
  writer.write(channel, 7, 1, 1, view("kept"));
  CHECK(McapReader(folder / "a.mcap").contents().messages == 0);
  writer.flush();
  const McapReader reader(folder / "a.mcap");
  CHECK(reader.contents().messages == 1);
  CHECK_FALSE(reader.complete());
  writer.flush();
  writer.write(channel, 8, 2, 2, view("after"));
  writer.close();
  CHECK(McapReader(folder / "a.mcap").complete());
}

TEST_CASE("a full disk is reported with the file name and the system error") {
  McapOptions replace{.replace = true};
  CHECK_THROWS_WITH(McapWriter("/dev/full", replace),
                    Catch::Contains("/dev/full: cannot write: No space left on device"));
}

TEST_CASE("a partial write is undone; later writes are rejected and earlier data is kept") {
  const test::Folder folder;
  rlimit original_limit{};
  getrlimit(RLIMIT_FSIZE, &original_limit);
  const auto original_handler = std::signal(SIGXFSZ, SIG_IGN);
  {
    McapWriter writer(folder / "a.mcap", {.compression = Compression::none});
    const auto channel = writer.add_channel("t", "cdr", 0);
    writer.write(channel, 0, 1, 1, view("first"));
    writer.flush();
    const rlimit limit{std::filesystem::file_size(folder / "a.mcap") + 30, original_limit.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limit);
    writer.write(channel, 1, 2, 2, view(std::string(1000, 'x')));
    CHECK_THROWS_WITH(writer.flush(), Catch::Contains("File too large"));
    setrlimit(RLIMIT_FSIZE, &original_limit);
    CHECK_THROWS_WITH(writer.write(channel, 2, 3, 3, view("y")), Catch::Contains("earlier write"));
    CHECK_THROWS_AS(writer.close(), RecordingError);
  }
  std::signal(SIGXFSZ, original_handler);
  const McapReader reader(folder / "a.mcap");
  CHECK(reader.contents().messages == 1);
  CHECK(reader.truncation().find("without a footer") != std::string::npos);
}

TEST_CASE("an existing recording is overwritten only with the option replace") {
  const test::Folder folder;
  test::write_file(folder / "a.mcap", "precious");
  CHECK_THROWS_WITH(McapWriter(folder / "a.mcap"), Catch::Contains("the file exists already"));
  CHECK(test::read_file(folder / "a.mcap") == "precious");
  CHECK_NOTHROW(McapWriter(folder / "a.mcap", {.replace = true}));
}

TEST_CASE("a channel or schema that was not added is rejected") {
  const test::Folder folder;
  McapWriter writer(folder / "a.mcap");
  CHECK_THROWS_AS(writer.add_channel("t", "cdr", 1), std::invalid_argument);
  CHECK_THROWS_AS(writer.write(1, 0, 0, 0, {}), std::invalid_argument);
}

TEST_CASE("a write to a closed recording is rejected") {
  const test::Folder folder;
  McapWriter writer(folder / "a.mcap");
  const auto channel = writer.add_channel("t", "cdr", 0);
  writer.close();
  writer.close();
  CHECK_THROWS_WITH(writer.write(channel, 0, 0, 0, {}), Catch::Contains("is closed"));
}

TEST_CASE(
    "with continue_after_failure a failed write loses its messages, and the next ones are kept") {
  const test::Folder folder;
  rlimit original_limit{};
  getrlimit(RLIMIT_FSIZE, &original_limit);
  const auto original_handler = std::signal(SIGXFSZ, SIG_IGN);
  McapWriter writer(folder / "a.mcap",
                    {.compression = Compression::none, .continue_after_failure = true});
  const auto channel = writer.add_channel("t", "cdr", 0);
  writer.write(channel, 0, 1, 1, view("first"));
  writer.flush();
  CHECK(writer.failure().empty());
  const rlimit limit{std::filesystem::file_size(folder / "a.mcap") + 30, original_limit.rlim_max};
  setrlimit(RLIMIT_FSIZE, &limit);
  for (std::uint64_t k : {2, 3, 4}) {
    writer.write(channel, 1, k, k, view(std::string(1000, 'x')));
    writer.flush();
    CHECK(writer.failure().find("File too large") != std::string::npos);
  }
  const auto other =
      writer.add_channel("late", "cdr", 0);  // its record is written with the next chunk
  setrlimit(RLIMIT_FSIZE, &original_limit);
  std::signal(SIGXFSZ, original_handler);
  writer.write(other, 0, 5, 5, view("last"));
  writer.flush();
  CHECK(writer.failure().empty());
  CHECK(writer.lost().count == 3);
  CHECK(writer.lost().first_ns == 2);
  CHECK(writer.lost().last_ns == 4);
  writer.close();
  const McapReader reader(folder / "a.mcap");
  CHECK(reader.complete());
  CHECK(reader.contents().messages == 2);
  std::vector<std::string> topics;
  reader.for_each([&](const Message& message) { topics.push_back(message.channel.topic); });
  CHECK(topics == std::vector<std::string>{"t", "late"});
}

TEST_CASE("a file that cannot be begun is removed") {
  const test::Folder folder;
  rlimit original_limit{};
  getrlimit(RLIMIT_FSIZE, &original_limit);
  const auto original_handler = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit limit{4, original_limit.rlim_max};
  setrlimit(RLIMIT_FSIZE, &limit);
  CHECK_THROWS_AS(McapWriter(folder / "a.mcap"), RecordingError);
  setrlimit(RLIMIT_FSIZE, &original_limit);
  std::signal(SIGXFSZ, original_handler);
  CHECK_FALSE(std::filesystem::exists(folder / "a.mcap"));
}
