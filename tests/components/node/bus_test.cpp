#include "components/node/bus.hpp"

#include <catch2/catch.hpp>
#include <cstdlib>
#include <thread>

#include "components/node/builtin.hpp"
#include "components/node/clock.hpp"
#include "components/node/histogram.hpp"
#include "tests/components/node/domain.hpp"

using namespace std::chrono_literals;

namespace {

/// Two matched participants in one process.
struct Pair {
  node::Entity left = node::join("left"), right = node::join("right");
  node::Wake wake;
  node::Writer<erp::SensorFrame> writer{left};
  node::Reader<erp::SensorFrame> reader;
  explicit Pair(int depth = 1) : reader(right, wake, depth) {
    while (!writer.matched() || !reader.matched()) std::this_thread::sleep_for(1ms);
  }
  /// Takes until a sample has arrived or 2000 attempts have failed.
  template <class Handle>
  void take(Handle&& handle) {
    for (int i = 0; i < 2000 && !reader.take(handle); ++i) std::this_thread::sleep_for(1ms);
  }
};

erp::SensorFrame frame_of(int actuators) {
  erp::SensorFrame frame;
  erp::assign(frame.robot, "test");
  for (int i = 0; i < actuators; ++i) {
    erp::ActuatorSample sample{};
    erp::assign(sample.name, "muscle_" + std::to_string(i));
    sample.tension_N = i;
    erp::append(frame.actuators, sample);
  }
  return frame;
}

}  // namespace

TEST_CASE("a message with 54 samples arrives with all its samples") {
  Pair pair;
  auto sent = frame_of(54);
  pair.writer.write(sent);
  int received = 0;
  pair.take([&](const erp::SensorFrame& message) {
    ++received;
    REQUIRE(message.actuators._length == 54);
    CHECK(std::string(message.actuators._buffer[53].name) == "muscle_53");
    CHECK(message.actuators._buffer[53].tension_N == 53);
    CHECK(message.joints._length == 0);
  });
  CHECK(received == 1);
}

TEST_CASE("a message of two samples after one of five arrives with two samples") {
  Pair pair;
  auto longer = frame_of(5), shorter = frame_of(2);
  pair.writer.write(longer);
  pair.take([](const auto&) {});
  pair.writer.write(shorter);
  std::uint32_t length = 99;
  pair.take([&](const erp::SensorFrame& message) { length = message.actuators._length; });
  CHECK(length == 2);
}

TEST_CASE("the first message after the end of another writer arrives with its own samples") {
  Pair pair;
  {
    node::Writer<erp::SensorFrame> earlier{pair.left};
    auto frame = frame_of(2);
    frame.actuators._buffer[0].tension_N = 99;
    while (!earlier.matched()) std::this_thread::sleep_for(1ms);
    earlier.write(frame);
    pair.take([](const auto&) {});
  }
  for (int k = 0; k < 100; ++k) {  // until the end of the writer has arrived
    pair.reader.take([](const auto&) {});
    std::this_thread::sleep_for(1ms);
  }
  auto frame = frame_of(3);
  pair.writer.write(frame);
  double tension_N = -1;
  pair.take([&](const erp::SensorFrame& message) {
    REQUIRE(message.actuators._length == 3);
    tension_N = message.actuators._buffer[0].tension_N + message.actuators._buffer[2].tension_N;
  });
  CHECK(tension_N == 2);
}

TEST_CASE("a gap of three sequence numbers is counted as three missed messages") {
  Pair pair(16);
  auto frame = frame_of(1);
  pair.writer.write(frame);
  pair.take([](const auto&) {});
  frame.sequence = 4;
  pair.writer.send(frame);
  pair.take([](const auto&) {});
  CHECK(pair.reader.missed() == 3);
}

TEST_CASE("a copy of a message has its own samples") {
  auto first = frame_of(3);
  erp::SensorFrame second = first;
  second.actuators._buffer[0].tension_N = 42;
  CHECK(first.actuators._buffer[0].tension_N == 0);
  first = second;
  CHECK(first.actuators._buffer[0].tension_N == 42);
  CHECK(first.actuators._buffer != second.actuators._buffer);
}

TEST_CASE("a sample beyond the capacity or a text beyond the bound is refused") {
  auto frame = frame_of(64);
  CHECK_THROWS_AS(erp::append(frame.actuators, erp::ActuatorSample{}), std::length_error);
  CHECK_THROWS_AS(erp::assign(frame.robot, std::string(33, 'x')), std::length_error);
}

TEST_CASE("the quantile of a histogram is the upper edge of its bin") {
  node::Histogram histogram;
  for (int i = 0; i < 99; ++i) histogram.add_ns(20'000);
  histogram.add_ns(1'000'000);
  CHECK(node::quantile_us(histogram.counts(), 0.5) == 32);
  CHECK(node::quantile_us(histogram.counts(), 0.995) == 1024);
}

TEST_CASE("data of a disconnected participant is discarded") {
  const node::Entity self = node::join("self");
  node::Wake wake;
  const node::DataCallback callback = node::wake_callback(wake);
  const node::Entity reader =
      node::make_builtin_reader(self, DDS_BUILTIN_TOPIC_DCPSPARTICIPANT, callback);
  const auto alive = [&] {
    int count = 0;
    node::for_each_alive<dds_builtintopic_participant_t>(
        reader, [&](const auto&, const auto&) { ++count; });
    return count;
  };
  {
    const node::Entity guest = node::join("guest");
    REQUIRE(alive() == 2);
  }
  REQUIRE(alive() == 1);
  node::BuiltinSamples buffers;
  CHECK(buffers.get(reader, dds_read_mask, DDS_ANY_STATE) == 1);  // in any state
}
