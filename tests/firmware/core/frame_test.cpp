#include "firmware/core/frame.h"

#include <catch2/catch.hpp>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

namespace {

std::mt19937 random_bits(1);
int pick(int low, int high) { return std::uniform_int_distribution(low, high)(random_bits); }
bool random_bool() { return pick(0, 1) == 1; }
std::uint8_t random_byte(int low, int high) { return std::uint8_t(pick(low, high)); }
int pick_setpoint() {
  const int edge[] = {0, FRAME_SETPOINT_MAX, -FRAME_SETPOINT_MAX, FRAME_SETPOINT_REFUSED};
  return random_bool() ? pick(-FRAME_SETPOINT_MAX, FRAME_SETPOINT_MAX) : edge[pick(0, 3)];
}

frame_status random_status() {
  frame_status s{};
  s.encoder_low = std::uint16_t(pick(0, 65535));
  s.current_counts = std::int16_t(pick(-2048, 2047));
  s.tension_counts = std::uint16_t(pick(0, 4095));
  s.state = random_byte(0, ECU_STATE_COUNT - 1);
  const bool running = s.state == ECU_STATE_RUNNING;
  s.duty = std::int16_t(running ? pick(-ECU_DUTY_MAX, ECU_DUTY_MAX) : 0);
  s.fault = running ? 0 : random_byte(0, 15);
  s.request = running ? FRAME_REQUEST_NONE : random_byte(0, 7);
  s.warning = !running && random_bool();
  s.follows = random_bool();
  s.counter = random_byte(0, 7);
  return s;
}

/// One intact frame of every function.
std::vector<bus_frame> one_frame_of_each(std::uint8_t ecu) {
  std::vector<bus_frame> frames(8);
  const frame_emergency emergency{false, 1, ECU_FAULT_OVER_TENSION, 0, FRAME_VERSION, 77};
  const frame_command command{{{ECU_REQUEST_FORCE, 40000}, {ECU_REQUEST_LENGTH, -5}}, 3, 1};
  const frame_status status = random_status();
  const frame_analog analog{0, 3, {-3129, 4172}, 5};
  const frame_health position{.page = 0, .counter = 2, .encoder_counts = -123456789};
  const frame_health followed{.page = 1, .request = 6, .setpoint = 40000};
  const frame_parameter parameter{1, 7, true, 21, 3.5f};
  frame_pack_emergency(&frames[0], ecu, &emergency);
  frame_pack_command(&frames[1], ecu, &command);
  frame_pack_status(&frames[2], ecu, 0, &status);
  frame_pack_status(&frames[3], ecu, 1, &status);
  frame_pack_analog(&frames[4], ecu, &analog);
  frame_pack_health(&frames[5], ecu, 0, &position);
  frame_pack_health(&frames[6], ecu, 1, &followed);
  frame_pack_parameter(&frames[7], ecu, &parameter);
  return frames;
}

void flip(bus_frame& frame, int bit) {
  frame.data[bit / 8] = std::uint8_t(frame.data[bit / 8] ^ 1u << bit % 8);
}

bool any_unpacks(const bus_frame& f) {
  frame_emergency emergency;
  frame_command command;
  frame_status status;
  frame_analog analog;
  frame_health health;
  frame_parameter parameter;
  return frame_unpack_emergency(&f, &emergency) || frame_unpack_command(&f, &command) ||
         frame_unpack_status(&f, &status) || frame_unpack_analog(&f, &analog) ||
         frame_unpack_health(&f, &health) || frame_unpack_parameter(&f, &parameter);
}

}  // namespace

TEST_CASE("a command is unchanged by pack and unpack") {
  for (int n = 0; n < 2000; ++n) {
    frame_command in{{{random_byte(0, 7), pick_setpoint()}, {random_byte(0, 7), pick_setpoint()}},
                     random_byte(0, 7),
                     random_byte(0, 7)},
        out{};
    bus_frame frame;
    const auto ecu = random_byte(0, 127);
    frame_pack_command(&frame, ecu, &in);
    REQUIRE(frame_unpack_command(&frame, &out));
    CHECK(frame_ecu_of(&frame) == ecu);
    for (int k : {0, 1}) {
      CHECK(out.channel[k].request == in.channel[k].request);
      CHECK(out.channel[k].setpoint == in.channel[k].setpoint);
    }
    CHECK(out.answers == in.answers);
    CHECK(out.count == in.count);
  }
}

TEST_CASE("a set-point beyond 22 bits arrives as refused, never as another number") {
  for (std::int32_t setpoint :
       {FRAME_SETPOINT_MAX + 1, -FRAME_SETPOINT_MAX - 1, INT32_MAX, INT32_MIN}) {
    const frame_command in{{{ECU_REQUEST_LENGTH, setpoint}, {}}, 0, 0};
    frame_command out;
    bus_frame frame;
    frame_pack_command(&frame, 1, &in);
    REQUIRE(frame_unpack_command(&frame, &out));
    CHECK(out.channel[0].setpoint == FRAME_SETPOINT_REFUSED);
  }
}

TEST_CASE("a status is unchanged by pack and unpack, in every state") {
  for (int n = 0; n < 5000; ++n) {
    const frame_status in = random_status();
    frame_status out{};
    bus_frame frame;
    const auto channel = random_byte(0, 1);
    frame_pack_status(&frame, random_byte(0, 127), channel, &in);
    REQUIRE(frame_unpack_status(&frame, &out));
    CHECK(frame_function_of(&frame) == (channel ? FRAME_STATUS_1 : FRAME_STATUS_0));
    CHECK(out.encoder_low == in.encoder_low);
    CHECK(out.current_counts == in.current_counts);
    CHECK(out.tension_counts == in.tension_counts);
    CHECK(out.state == in.state);
    CHECK(out.duty == in.duty);
    CHECK(out.fault == in.fault);
    CHECK(out.request == in.request);
    CHECK(out.warning == in.warning);
    CHECK(out.follows == in.follows);
    CHECK(out.counter == in.counter);
  }
}

TEST_CASE("a status saturates values outside the converter range") {
  frame_status in{
      .current_counts = 32767, .tension_counts = 65535, .state = ECU_STATE_RUNNING, .duty = -2000},
      out{};
  bus_frame frame;
  frame_pack_status(&frame, 1, 0, &in);
  REQUIRE(frame_unpack_status(&frame, &out));
  CHECK(out.current_counts == 2047);
  CHECK(out.tension_counts == 4095);
  CHECK(out.duty == -1023);
}

TEST_CASE("analog, health, parameter and emergency frames are unchanged by pack and unpack") {
  for (int n = 0; n < 2000; ++n) {
    bus_frame frame;
    const frame_analog a{random_byte(0, 1),
                         random_byte(0, 3),
                         {pick(-8388608, 8388607), pick(-8388608, 8388607)},
                         random_byte(0, 7)};
    frame_analog a_out{};
    frame_pack_analog(&frame, 9, &a);
    REQUIRE(frame_unpack_analog(&frame, &a_out));
    CHECK(std::tie(a.page, a.present, a.counts[0], a.counts[1], a.counter) ==
          std::tie(a_out.page, a_out.present, a_out.counts[0], a_out.counts[1], a_out.counter));

    const frame_health p{.page = 0,
                         .counter = random_byte(0, 7),
                         .encoder_counts = pick(INT32_MIN, INT32_MAX),
                         .warning = random_bool(),
                         .lost = random_byte(0, 255),
                         .corrupt = random_byte(0, 255),
                         .zero_known = random_bool()};
    frame_health p_out{};
    frame_pack_health(&frame, 9, random_byte(0, 1), &p);
    REQUIRE(frame_unpack_health(&frame, &p_out));
    CHECK(std::tie(p.page, p.counter, p.encoder_counts, p.warning, p.lost, p.corrupt,
                   p.zero_known) == std::tie(p_out.page, p_out.counter, p_out.encoder_counts,
                                             p_out.warning, p_out.lost, p_out.corrupt,
                                             p_out.zero_known));

    const frame_health f{.page = 1,
                         .counter = random_byte(0, 7),
                         .request = random_byte(0, 7),
                         .setpoint = pick_setpoint(),
                         .rejected = std::uint16_t(pick(0, 65535)),
                         .refused_gain_sets = random_byte(0, 255),
                         .accepted_gain_sets = random_byte(0, 7)};
    frame_health f_out{};
    frame_pack_health(&frame, 9, random_byte(0, 1), &f);
    REQUIRE(frame_unpack_health(&frame, &f_out));
    CHECK(std::tie(f.page, f.counter, f.request, f.setpoint, f.rejected, f.refused_gain_sets,
                   f.accepted_gain_sets) ==
          std::tie(f_out.page, f_out.counter, f_out.request, f_out.setpoint, f_out.rejected,
                   f_out.refused_gain_sets, f_out.accepted_gain_sets));

    const auto bits = random_bits();
    frame_parameter g{random_byte(0, 1), random_byte(0, 63), random_bool(), random_byte(0, 255), 0},
        g_out{};
    std::memcpy(&g.value, &bits, 4);
    frame_pack_parameter(&frame, 9, &g);
    REQUIRE(frame_unpack_parameter(&frame, &g_out));
    CHECK(std::tie(g.channel, g.index, g.commit, g.position) ==
          std::tie(g_out.channel, g_out.index, g_out.commit, g_out.position));
    CHECK(std::memcmp(&g.value, &g_out.value, 4) == 0);

    const frame_emergency e{random_bool(),      random_byte(0, 1),  random_byte(0, 15),
                            random_byte(0, 15), random_byte(0, 63), std::uint32_t(random_bits())};
    frame_emergency e_out{};
    frame_pack_emergency(&frame, 9, &e);
    REQUIRE(frame_unpack_emergency(&frame, &e_out));
    CHECK(std::tie(e.boot, e.channel, e.fault, e.reset_cause, e.version, e.tick) ==
          std::tie(e_out.boot, e_out.channel, e_out.fault, e_out.reset_cause, e_out.version,
                   e_out.tick));
  }
}

TEST_CASE("a frame with one flipped bit, in data or identifier, is rejected") {
  for (const bus_frame& good : one_frame_of_each(77)) {
    REQUIRE(any_unpacks(good));
    for (int bit = 0; bit < 64; ++bit) {
      bus_frame bad = good;
      flip(bad, bit);
      INFO("function " << frame_function_of(&good) << ", data bit " << bit);
      CHECK_FALSE(any_unpacks(bad));
    }
    for (int bit = 0; bit < 16; ++bit) {
      bus_frame bad = good;
      bad.id = std::uint16_t(bad.id ^ 1u << bit);
      INFO("function " << frame_function_of(&good) << ", identifier bit " << bit);
      CHECK_FALSE(any_unpacks(bad));
    }
  }
}

TEST_CASE("a frame with up to three flipped bits is rejected") {
  for (const bus_frame& good : one_frame_of_each(5))
    for (int a = 0; a < 64; ++a)
      for (int b = a; b < 64; ++b)
        for (int c = b; c < 64; c += 3) {
          bus_frame bad = good;
          for (int bit : {a, b, c}) flip(bad, bit);
          if (std::memcmp(bad.data, good.data, 8) != 0 && any_unpacks(bad))
            FAIL("bits " << a << ' ' << b << ' ' << c);
        }
}

TEST_CASE("a frame of another length is rejected") {
  for (bus_frame frame : one_frame_of_each(5))
    for (int size : {0, 1, 7, 9, 255}) {
      frame.size = std::uint8_t(size);
      CHECK_FALSE(any_unpacks(frame));
    }
}

TEST_CASE("the check value is AUTOSAR's CRC-8 with polynomial 0x2F") {
  const std::uint8_t text[] = {'1', '2', '3', '4', '5', '6', '7', '8', '9'};
  CHECK(frame_crc8(text, 9) == 0xDF);  // specification of the CRC library, 7.2.1.2
  const std::uint8_t checked_bytes[] = {0x31, 0x03, 1, 2, 3, 4, 5, 6, 7};
  const bus_frame frame{0x0331, 8, {1, 2, 3, 4, 5, 6, 7, frame_crc8(checked_bytes, 9)}};
  CHECK(frame_is_intact(&frame));
}

TEST_CASE("the encoder is unwrapped across both ends of 16 bits and of 32 bits") {
  CHECK(frame_unwrap(0, 0xFFFF) == -1);
  CHECK(frame_unwrap(65535, 0) == 65536);
  CHECK(frame_unwrap(-1, 0) == 0);
  CHECK(frame_unwrap(1000000, std::uint16_t(1000000 - 32768)) == 1000000 - 32768);
  CHECK(frame_unwrap(1000000, std::uint16_t(1000000 + 32767)) == 1000000 + 32767);
  CHECK(frame_unwrap(INT32_MAX, 0) == INT32_MIN);
}

TEST_CASE("the unwrapped encoder follows a random walk of any length") {
  std::int64_t truth = 0;
  std::int32_t unwrapped = 0;
  for (int n = 0; n < 100000; ++n) {
    truth += pick(-32768 + 20000, 32767);  // drifts far beyond 16 bits
    if (truth > INT32_MAX) break;
    unwrapped = frame_unwrap(unwrapped, std::uint16_t(truth));
    REQUIRE(unwrapped == truth);
  }
  CHECK(truth > 65536);
}
