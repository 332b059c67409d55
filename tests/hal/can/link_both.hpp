#pragma once
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstring>
#include <vector>

#include "hal/can/bus.hpp"
#include "hal/can/gateway.hpp"
#include "hal/can/robot_ecus.hpp"
#include "tests/hal/can/rig.hpp"

/// Checks that every back end must pass: UDP, and SocketCAN if available.
namespace can_test {

/// A bus specification with an unused port.
inline std::string free_udp_bus() {
  const int fd = ::socket(AF_INET, SOCK_DGRAM, 0);
  sockaddr_in where{};
  where.sin_family = AF_INET;
  where.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t size = sizeof where;
  REQUIRE(::bind(fd, reinterpret_cast<sockaddr*>(&where), size) == 0);
  REQUIRE(::getsockname(fd, reinterpret_cast<sockaddr*>(&where), &size) == 0);
  ::close(fd);
  return "udp:239.255.42.1:" + std::to_string(ntohs(where.sin_port));
}

inline erp::CanFrame numbered(unsigned n) {
  erp::CanFrame frame{std::uint16_t(n % 0x800), std::uint8_t(n % 9), {}};
  for (unsigned i = 0; i < frame.size; ++i) frame.data[i] = std::uint8_t(n >> i);
  return frame;
}

inline bool same(const erp::CanFrame& a, const erp::CanFrame& b) {
  return a.id == b.id && a.size == b.size && std::memcmp(a.data, b.data, a.size) == 0;
}

/// Waits for `count` frames.
inline std::vector<erp::CanFrame> collect(erp::CanBus& bus, std::size_t count) {
  std::vector<erp::CanFrame> frames(count);
  for (std::size_t count_received = 0; count_received < count;)
    count_received += bus.receive(std::span(frames).subspan(count_received), 10);
  return frames;
}

inline void receives_in_order(const std::string& specification) {
  const auto a = erp::open_bus(specification), b = erp::open_bus(specification);
  std::vector<erp::CanFrame> sent;
  for (unsigned n = 0; n < 150; ++n) sent.push_back(numbered(n));
  for (auto* pair : {&a, &b}) {
    auto& to = pair == &a ? b : a;
    REQUIRE((*pair)->send(sent) == sent.size());
    const auto received = collect(*to, sent.size());
    for (std::size_t n = 0; n < sent.size(); ++n) REQUIRE(same(received[n], sent[n]));
  }
  CHECK(a->counters().sent == 150);
  CHECK(a->counters().received == 150);
  CHECK(a->counters().refused == 0);
}

inline void does_not_receive_own_frames(const std::string& specification) {
  const auto a = erp::open_bus(specification), b = erp::open_bus(specification);
  const auto own_frame = numbered(1), other = numbered(2);
  a->send({&own_frame, 1});
  b->send({&other, 1});
  CHECK(same(collect(*a, 1)[0], other));
  CHECK(same(collect(*b, 1)[0], own_frame));
  erp::CanFrame extra;
  CHECK(a->receive({&extra, 1}, 0) == 0);
  CHECK(b->receive({&extra, 1}, 0) == 0);
}

inline void all_participants_receive(const std::string& specification) {
  const auto a = erp::open_bus(specification), b = erp::open_bus(specification),
             c = erp::open_bus(specification);
  const auto frame = numbered(77);
  a->send({&frame, 1});
  CHECK(same(collect(*b, 1)[0], frame));
  CHECK(same(collect(*c, 1)[0], frame));
}

inline void keeps_remaining_frames(const std::string& specification) {
  const auto a = erp::open_bus(specification), b = erp::open_bus(specification);
  std::vector<erp::CanFrame> sent;
  for (unsigned n = 0; n < 10; ++n) sent.push_back(numbered(n));
  a->send(sent);
  for (unsigned n = 0; n < 10; n += 2) {
    const auto two = collect(*b, 2);
    CHECK(same(two[0], sent[n]));
    CHECK(same(two[1], sent[n + 1]));
  }
}

/// 500 ticks of a robot with 11 actuators, both sides in this thread, compared with a run without a
/// bus.
inline void runs_in_lockstep(const std::string& specification,
                             const erp::BusOptions& options = {}) {
  const auto robot = robot_of(11);
  SimulatedChannels simulated(robot, 1), direct(robot, 1);
  erp::RobotEcus ecus(robot, simulated.channel_pointers);
  erp::Gateway gateway(robot);
  const auto robot_side = erp::open_bus(specification, options),
             host_side = erp::open_bus(specification, options);
  std::array<erp::CanFrame, 32> frames;
  std::mt19937 random(9);

  const auto gains = gains_for(robot);
  direct.apply(gains);
  const auto all = gateway.parameters(gains);
  for (std::size_t sent = 0, received = 0; received < all.size();) {  // as much as the bus accepts
    sent += host_side->send(all.subspan(sent, std::min<std::size_t>(64, all.size() - sent)));
    const auto count = robot_side->receive(frames, 10);
    for (std::size_t i = 0; i < count; ++i) ecus.receive(frames[i]);
    received += count;
  }
  for (int tick = 0; tick < 500; ++tick) {
    INFO("tick " << tick);
    direct.tick();
    simulated.tick();
    const auto content = ecus.report(simulated.frame);
    REQUIRE(robot_side->send(content) == content.size());
    for (bool is_complete = false; !is_complete;) {
      const auto count = host_side->receive(frames, 10);
      for (std::size_t i = 0; i < count; ++i)
        is_complete = gateway.receive(frames[i]) == erp::FrameResult::tick || is_complete;
    }
    REQUIRE(difference(gateway.frame(), direct.frame) == "");
    auto command = any_command(robot, gateway.frame().sequence, random);
    for (const auto& actuator : robot.actuators) {  // lockstep needs a command to every ECU
      const auto requested = erp::samples(command.channels);
      const bool is_commanded = std::any_of(requested.begin(), requested.end(),
                                            [&](const auto& c) { return c.ecu == actuator.ecu; });
      if (!is_commanded)
        erp::append(command.channels, erp::EcuChannelCommand{std::uint8_t(actuator.ecu),
                                                             std::uint8_t(actuator.channel), 0, 0});
    }
    direct.apply(command);
    const auto commands = gateway.commands(command);
    REQUIRE(host_side->send(commands) == commands.size());
    while (!ecus.answered()) {
      const auto count = robot_side->receive(frames, 10);
      for (std::size_t i = 0; i < count; ++i) ecus.receive(frames[i]);
    }
  }
  CHECK(gateway.counters().lost == 0);
  CHECK(gateway.counters().corrupt == 0);
}

}  // namespace can_test
