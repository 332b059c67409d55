// Writes the binary seeds: messages of ECUs, hosts and the logger, in the input format of each
// target.
//   fuzz_seeds CORPUS_DIRECTORY
#include <cstdio>

#include "firmware/board/wire.h"
#include "firmware/core/bundle.h"
#include "interfaces/recording/compression.hpp"
#include "interfaces/recording/mcap_writer.hpp"
#include "interfaces/topics.hpp"
#include "tests/firmware/core/channel.hpp"
#include "tests/fuzz/input.hpp"
#include "tests/interfaces/recording/tables.hpp"

namespace {

std::string corpus;

void write(const std::string& target, const std::string& name, const std::string& bytes) {
  std::filesystem::create_directories(corpus + "/" + target);
  std::ofstream(corpus + "/" + target + "/" + name, std::ios::binary) << bytes;
}

template <class T>
std::string bytes_of(const T& value) {
  return {reinterpret_cast<const char*>(&value), sizeof value};
}

std::string bytes_of(const bus_frame& frame) {
  return bytes_of(frame.id) + bytes_of(frame.size) +
         std::string(reinterpret_cast<const char*>(frame.data), 8);
}

/// One step of the targets `ecu` and `gateway`: action and data.
std::string step(char action, const std::string& data) { return action + data; }

bus_frame command(std::uint8_t count, std::uint8_t request, std::int32_t setpoint) {
  const frame_command message{{{request, setpoint}, {request, -setpoint}}, 0, count};
  bus_frame frame;
  frame_pack_command(&frame, 3, &message);
  return frame;
}

std::string readings(std::uint8_t flags, std::int32_t encoder, std::int16_t current) {
  std::string bytes = bytes_of(flags);
  for (int k = 0; k < 2; ++k)
    bytes += bytes_of(encoder) + bytes_of(current) + bytes_of(std::uint16_t{900}) +
             bytes_of(std::uint16_t{650}) + bytes_of(std::uint16_t{2400});
  return bytes + std::string(16, '\1');
}

// ---- ecu ----

void write_commands() {
  for (std::uint8_t mode = ECU_REQUEST_OFF; mode <= ECU_REQUEST_FORCE; ++mode) {
    std::string bytes = "\x5F" + step(0, bytes_of(command(0, ECU_REQUEST_ARM, 0)));
    for (std::uint8_t i = 1; i < 6; ++i)
      bytes += step(0, bytes_of(command(i, mode, 300 * i))) + step(2, readings(0, 20 * i, 10));
    write("ecu", "mode_" + std::to_string(mode), bytes + step(3, ""));
  }
}

void write_gains() {
  std::string bytes = "\x3F";
  const auto gains = firmware::fitted_gains();
  for (std::uint8_t i = 0; i < ECU_PARAMETER_COUNT; ++i) {
    const frame_parameter message{0, i, i + 1 == ECU_PARAMETER_COUNT, i, gains[i]};
    bus_frame frame;
    frame_pack_parameter(&frame, 3, &message);
    bytes += step(0, bytes_of(frame));
  }
  write("ecu", "gains", bytes + step(2, readings(0, 5, 5)));
}

void write_bundles_and_faults() {
  bus_frame frames[3] = {command(0, ECU_REQUEST_ARM, 0), command(1, ECU_REQUEST_VOLTAGE, 900), {}};
  frame_pack_discover(&frames[2], FRAME_EVERYONE);
  bus_bundle bundle;
  bundle_pack(&bundle, frames, 2);
  write("ecu", "bundle", "\x5F" + step(1, bytes_of(bundle)) + step(2, readings(0, 1, 1)));
  write("ecu", "discover", "\x5F" + step(0, bytes_of(frames[2])) + step(2, readings(0, 1, 1)));
  write("ecu", "bus_off", "\x5F" + step(2, readings(2, 1, 1)) + step(3, ""));
  write("ecu", "overrun", "\x5F" + step(2, readings(1 + 60, 1, 2000)));
}

// ---- gateway ----

std::string hello(std::uint8_t ecu) {
  const frame_hello message{FRAME_VERSION, 3, 9, 0, 77};
  bus_frame frame;
  frame_pack_hello(&frame, ecu, &message);
  return step(7, bytes_of(frame));
}

std::string health(std::uint8_t ecu, std::uint8_t channel, std::uint8_t page) {
  frame_health message{};
  message.page = page, message.encoder_counts = 70000, message.request = ECU_REQUEST_FORCE,
  message.setpoint = 9;
  bus_frame frame;
  frame_pack_health(&frame, ecu, channel, &message);
  return step(7, bytes_of(frame));
}

std::string status(std::uint8_t ecu, std::uint8_t channel, std::uint8_t counter,
                   std::uint8_t state) {
  frame_status message{};
  message.encoder_low = 4000, message.current_counts = -5, message.tension_counts = 900;
  message.state = state, message.counter = counter, message.follows = true;
  message.request = state == ECU_STATE_RUNNING ? FRAME_REQUEST_NONE : ECU_REQUEST_ARM;
  bus_frame frame;
  frame_pack_status(&frame, ecu, channel, &message);
  return step(7, bytes_of(frame));
}

std::string analog(std::uint8_t page, std::uint8_t counter) {
  const frame_analog message{page, 3, {-4000, 4000}, counter};
  bus_frame frame;
  frame_pack_analog(&frame, 3, &message);
  return step(7, bytes_of(frame));
}

std::string emergency(bool boot) {
  frame_emergency message{};
  message.boot = boot, message.version = FRAME_VERSION, message.tick = 12, message.fault = !boot;
  bus_frame frame;
  frame_pack_emergency(&frame, 3, &message);
  return step(7, bytes_of(frame));
}

void write_gateway() {
  std::string startup = hello(3) + hello(4) + hello(9);
  for (std::uint8_t page = 0; page < 2; ++page)
    startup += health(3, 0, page) + health(3, 1, page) + health(4, 0, page);
  write("gateway", "heard", startup);
  for (std::uint8_t state = ECU_STATE_BOOT; state < ECU_STATE_COUNT; ++state) {
    std::string ticks = startup;
    for (std::uint8_t i = 0; i < 2; ++i)
      ticks += status(3, 0, i, state) + status(3, 1, i, state) + analog(0, i) + analog(1, i) +
               status(4, 0, i, state) + step(2, "");
    write("gateway", "state_" + std::to_string(state), ticks);
  }
  write("gateway", "emergencies", startup + emergency(false) + emergency(true) + step(3, ""));
  const std::string channels = bytes_of(erp::EcuChannelCommand{3, 0, ECU_REQUEST_FORCE, 4000}) +
                               bytes_of(erp::EcuChannelCommand{4, 0, 200, 1 << 30});
  write("gateway", "command", startup + step(0, std::string("\1\2") + channels));
  write("gateway", "parameter",
        step(1, std::string("\2\3\0\5\0", 5) + bytes_of(1.5f) + std::string("\4\0\6\1", 4) +
                    bytes_of(2.5f)));
}

// ---- wire ----

void write_wire() {
  std::uint8_t bytes[WIRE_MESSAGE_MAX];
  const auto message = [&](unsigned size) { return std::string(bytes, bytes + size); };
  board_readings readings{};
  readings.channel[0].encoder_counts = -70000, readings.analog[3] = 8000, readings.turn = 7;
  const std::int16_t duty[2] = {-1023, 512};
  const wire_fault fault{WIRE_FAULT_BUSY, 40};
  write("wire", "readings", message(wire_pack_readings(bytes, 3, &readings)));
  write("wire", "drive", message(wire_pack_drive(bytes, 3, duty)));
  write("wire", "sample", message(wire_pack_sample(bytes, 3, 9)));
  write("wire", "fault", "\xA5\xA5" + message(wire_pack_fault(bytes, 3, &fault)));
}

// ---- recording ----

using recording::Bytes;

/// The magic bytes and the header record of an MCAP file.
Bytes mcap_header() {
  Bytes out;
  recording::put(out, std::as_bytes(std::span(recording::magic)));
  const auto header = recording::begin_record(out, recording::Op::header);
  recording::put(out, std::uint64_t{0});
  recording::end_record(out, header);
  return out;
}

void put_topic(Bytes& out, std::uint16_t id, const std::string& topic, const std::string& schema) {
  recording::put_schema(out, {id, "erp/msg/Any", "ros2msg", schema});
  recording::put_channel(out, {id, id, topic, "cdr", {}});
}

struct Recorded {
  std::string topic, schema;
  std::vector<Bytes> messages;
};

/// A recording without chunks and checksums: a reader does not reject changed bytes by their
/// checksum.
std::string unchunked_recording(const std::vector<Recorded>& topics) {
  Bytes out = mcap_header();
  std::uint16_t id = 0;
  for (const Recorded& recorded : topics) {
    put_topic(out, ++id, recorded.topic, recorded.schema);
    std::uint32_t n = 0;
    for (const Bytes& message : recorded.messages) {
      recording::put_message(out, {id, n, 10 + n, 10 + n}, message);
      ++n;
    }
  }
  return std::string(recording::text(out));
}

/// Two chunks that overlap in time, one of them compressed, without checksums.
std::string overlapping_chunks() {
  Bytes out = mcap_header();
  put_topic(out, 1, "a", "string data\nb[<=2] bs\n===\nMSG: erp/b\nfloat64[2] x\n");
  for (const bool compressed : {false, true}) {
    Bytes records;
    for (std::uint64_t i = 0; i < 3; ++i)
      recording::put_message(records, {1, static_cast<std::uint32_t>(i), 10 * i + compressed, i},
                             test::CdrWriter().string("hi").put(1u).put(.5).put(1.5).bytes);
    recording::put_chunk(out, {0, 30, records.size(), 0, compressed ? "zstd" : ""},
                         compressed ? recording::compress_zstd(records) : records);
  }
  return std::string(recording::text(out));
}

std::string writer_output(recording::Compression compression) {
  const fuzz::Folder folder;
  const std::string path = folder / "run.mcap";
  recording::McapWriter writer(path, {.compression = compression, .chunk_bytes = 64});
  writer.attach("robot.xml", "text/xml", "<robot name=\"rig\"/>");
  writer.add_metadata({"who", {{"name", "nobody"}}});
  const auto schema = writer.add_schema("a/msg/B", "ros2msg", "string data\nuint8[3] b\n");
  const auto channel = writer.add_channel("a", "cdr", schema, {{"writer", "x"}});
  for (std::uint32_t i = 0; i < 4; ++i)
    writer.write(channel, i, 100 + i, 99 + i, test::CdrWriter().string("hi").put(i).bytes);
  writer.close();
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

void write_recording() {
  const test::ActuatorRow row{.name = "flexor", .reference = 4, .tension_N = 5};
  const Recorded frames{
      "sensor_frame",
      test::frame_schema,
      {test::frame(1000, 1, {row}, {{"elbow"}}), test::frame(2000, 2, {row}, {})}};
  const Recorded joints{"joint_state", test::joint_schema, {test::ball(1000, "shoulder", 1)}};
  const Recorded targets{
      "actuator_target", test::target_schema, {test::target(1, "flexor", 4, 2.5)}};
  write("recording", "frames", unchunked_recording({frames}));
  write("recording", "joined", unchunked_recording({frames, joints, targets}));
  write("recording", "chunks", overlapping_chunks());
  const std::string complete_file = writer_output(recording::Compression::none);
  write("recording", "whole", complete_file);
  write("recording", "cut", complete_file.substr(0, complete_file.size() / 2));
  write("recording", "zstd", writer_output(recording::Compression::zstd));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "fuzz_seeds CORPUS_DIRECTORY\n"), 1;
  corpus = argv[1];
  write_commands(), write_gains(), write_bundles_and_faults();
  write_gateway(), write_wire(), write_recording();
  return 0;
}
