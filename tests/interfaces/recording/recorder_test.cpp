#include "interfaces/recording/recorder.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <csignal>

#include "interfaces/recording/mcap_reader.hpp"
#include "tests/interfaces/recording/support.hpp"

using namespace recording;

namespace {

const MessageType frame_type{"erp/msg/SensorFrame", "bool x\n", "module erp {};"};

Sample sample(std::string_view writer, std::uint64_t sequence, std::uint64_t time_ns = 0) {
  return {writer, time_ns, time_ns, sequence, view("data")};
}

}  // namespace

TEST_CASE("the attachments are in the file before the first message") {
  const test::Folder folder;
  Recorder recorder(folder / "a.mcap", {{0, 0, "git_revision", "text/plain", "abc"}});
  CHECK(McapReader(folder / "a.mcap").attachments().at(0).data == "abc");
  recorder.add_topic("sensor_frame", frame_type);
  const McapReader reader(folder / "a.mcap");
  CHECK(reader.attachments().at(1).name == "erp/msg/SensorFrame.idl");
}

TEST_CASE("recorder and reader count missing messages separately for each writer of a topic") {
  const test::Folder folder;
  Recorder recorder(folder / "a.mcap", {});
  const auto topic = recorder.add_topic("actuator_command", frame_type);
  for (const std::uint64_t n : {1, 2, 5}) recorder.write(topic, sample("left", n));
  for (const std::uint64_t n : {100, 101}) recorder.write(topic, sample("right", n));
  recorder.write(topic, sample("left", 0));
  recorder.write(topic, {.writer = "mute", .cdr = view("no number")});
  recorder.write(topic, {.writer = "mute", .cdr = view("no number")});
  const TopicCount& count = recorder.counts().at(topic);
  CHECK(count.messages == 8);
  CHECK(count.missing == 2);
  CHECK(count.restarts == 1);
  CHECK(count.writers == 3);
  CHECK(recorder.missing() == 2);
  recorder.close();
  const McapReader reader(folder / "a.mcap");
  std::uint64_t missing = 0;
  for (const auto& [id, statistics] : reader.statistics()) missing += statistics.missing;
  CHECK(missing == 2);
  CHECK(reader.channels().at(1).metadata.at("writer") == "left");
  CHECK(reader.channels().size() == 3);
  CHECK(reader.schemas().size() == 1);
}

TEST_CASE(
    "a topic added twice has the same handle; the topic with another type has another handle") {
  const test::Folder folder;
  Recorder recorder(folder / "a.mcap", {});
  CHECK(recorder.add_topic("t", frame_type) == recorder.add_topic("t", frame_type));
  CHECK(recorder.add_topic("t", {"other", "bool y\n", ""}) == 1);
  CHECK(recorder.add_topic("u", {"unknown", "", ""}) == 2);
}

TEST_CASE("a tick writes data to the disk after half a second and not before") {
  const test::Folder folder;
  Recorder recorder(folder / "a.mcap", {});
  const auto on_disk = [&] { return McapReader(folder / "a.mcap").contents().messages; };
  const auto topic = recorder.add_topic("t", frame_type);
  recorder.tick(0);
  recorder.write(topic, sample("w", 1));
  recorder.tick(10'000'000'000);
  recorder.tick(10'499'999'999);
  CHECK(on_disk() == 0);
  recorder.tick(10'500'000'000);
  CHECK(on_disk() == 1);
}

TEST_CASE("a killed recorder loses less than one second of data, and recover completes the file") {
  const test::Folder folder;
  constexpr std::uint64_t messages = 2000;  // at 500 Hz: 4 s
  const pid_t child = fork();
  if (child == 0) {
    Recorder recorder(folder / "a.mcap", {});
    const auto topic = recorder.add_topic("t", frame_type);
    for (std::uint64_t i = 0; i < messages; ++i) {
      recorder.write(topic, sample("w", i, i * 2'000'000));
      if (i % 50 == 0) recorder.tick(static_cast<std::int64_t>(i) * 2'000'000);
    }
    kill(getpid(), SIGKILL);
  }
  int status = 0;
  waitpid(child, &status, 0);
  REQUIRE(WIFSIGNALED(status));
  const McapReader reader(folder / "a.mcap");
  CHECK_FALSE(reader.complete());
  CHECK(reader.contents().messages >= messages - 500);
  CHECK(recover(folder / "a.mcap", folder / "b.mcap").messages == reader.contents().messages);
  CHECK(McapReader(folder / "b.mcap").complete());
}
