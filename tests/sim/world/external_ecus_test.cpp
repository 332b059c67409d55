#include "sim/world/external_ecus.hpp"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <catch2/catch.hpp>

#include "hal/can/ecu_watch.hpp"
#include "tests/sim/rigs.hpp"

namespace {

constexpr int port = 21700;

/// A socket in place of an ECU.
class Pins {
 public:
  Pins() {
    sockaddr_in robot{};
    robot.sin_family = AF_INET;
    robot.sin_port = htons(port);
    robot.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    REQUIRE(::connect(fd_, reinterpret_cast<const sockaddr*>(&robot), sizeof robot) == 0);
  }
  ~Pins() { ::close(fd_); }

  void request(std::uint8_t turn = 0) {
    std::array<std::uint8_t, WIRE_MESSAGE_MAX> bytes;
    REQUIRE(::send(fd_, bytes.data(), wire_pack_sample(bytes.data(), 0, turn), 0) > 0);
  }
  void drive(std::int16_t flexor, std::int16_t extensor) {
    const std::array duty{flexor, extensor};
    std::array<std::uint8_t, WIRE_MESSAGE_MAX> bytes;
    REQUIRE(::send(fd_, bytes.data(), wire_pack_drive(bytes.data(), 0, duty.data()), 0) > 0);
  }
  std::vector<board_readings> received() {
    std::vector<board_readings> all;
    std::array<std::uint8_t, 512> bytes;
    const ssize_t n = ::recv(fd_, bytes.data(), bytes.size(), MSG_DONTWAIT);
    for (ssize_t i = 0; i < n; ++i)
      if (wire_take(&reader_, bytes[std::size_t(i)]) == WIRE_READINGS)
        wire_unpack_readings(&reader_, &all.emplace_back());
    return all;
  }

 private:
  int fd_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  wire_reader reader_{};
};

/// The rig with its only ECU as an external one.
struct Rig {
  explicit Rig(bool lockstep = false)
      : robot(erp::read_robot(rigs::config("hinge_rig/robot.xml"))),
        world(robot),
        ecus(robot, options(lockstep)) {
    ecus.measure(world);
  }
  static sim::ExternalEcus::Options options(bool lockstep) {
    sim::ExternalEcus::Options chosen{port, ""};
    chosen.lockstep = lockstep;
    return chosen;
  }
  bool receive() {
    pollfd ready{ecus.descriptors().at(0), POLLIN, 0};
    REQUIRE(::poll(&ready, 1, 1000) == 1);
    return ecus.receive();
  }
  /// Number of steps that the world simulated out of the given number.
  int step(int times) {
    int simulated = 0;
    for (int k = 0; k < times; ++k) simulated += ecus.step(world);
    return simulated;
  }
  std::vector<board_readings> request(Pins& pins) {
    pins.request(), receive();
    return pins.received();
  }

  erp::Robot robot;
  sim::World world;
  sim::ExternalEcus ecus;
};

int counts(const board_readings& readings) { return readings.channel[0].encoder_counts; }

}  // namespace

TEST_CASE(
    "a request before the end of a period receives the next readings at the end of the period") {
  Rig rig;
  Pins pins;
  REQUIRE(rig.request(pins).size() == 1);  // the current readings
  CHECK(rig.request(pins).empty());
  rig.step(3);
  CHECK(pins.received().empty());
  rig.step(1);
  CHECK(pins.received().size() == 1);
}

TEST_CASE(
    "a request after missed periods receives the readings of every missed period, evenly spaced") {
  Rig rig;
  Pins pins;
  REQUIRE(rig.request(pins).size() == 1);
  pins.drive(1023, 0), rig.receive();
  // The ECU sends duties, because otherwise the world would wait for it, but no request.
  const auto turn_for = [&](int steps) {
    for (int k = 0; k < steps; ++k) rig.step(1), pins.drive(1023, 0), rig.receive();
  };
  turn_for(80);  // up to speed; no request for longer than readings are stored
  const auto first = rig.request(pins);
  REQUIRE(first.size() == 1);
  turn_for(13);
  const auto late_readings = rig.request(pins);
  REQUIRE(late_readings.size() == 3);
  CHECK(rig.request(pins).empty());
  rig.step(3);  // the fourth reading is now due
  const auto next = pins.received();
  REQUIRE(next.size() == 1);
  const std::array encoder_counts{counts(first[0]), counts(late_readings[0]),
                                  counts(late_readings[1]), counts(late_readings[2]),
                                  counts(next[0])};
  const int turned = encoder_counts[1] - encoder_counts[0];
  REQUIRE(turned > 20);
  for (std::size_t k = 2; k < encoder_counts.size(); ++k)
    CHECK(encoder_counts[k] - encoder_counts[k - 1] == Approx(turned).epsilon(0.05));
}

TEST_CASE("the world waits for an ECU whose message is overdue, not for a disconnected ECU") {
  Rig rig;
  Pins pins;
  REQUIRE(rig.request(pins).size() == 1);
  const int overdue = sim::ExternalEcus::overdue_steps, silent = sim::ExternalEcus::silent_steps;
  CHECK(rig.step(silent - 1) == overdue);
  CHECK(rig.step(10) == 10);
  CHECK(rig.ecus.alive() == 0);
}

TEST_CASE(
    "while the world waits for one ECU, a gateway does not report the other ECUs as disconnected") {
  using sim::ExternalEcus;
  const int wait = ExternalEcus::silent_steps - ExternalEcus::overdue_steps;
  const double message_period_s =
      2 * ExternalEcus::steps_per_tick * ExternalEcus::step_s;  // between two messages
  CHECK(wait * ExternalEcus::step_s + message_period_s < 1e-9 * double(erp::EcuWatch::silent_ns));
}

TEST_CASE("in lockstep the next readings are sent when all ECUs have requested them") {
  Rig rig(true);
  Pins pins;
  pins.request(0);
  CHECK_FALSE(rig.receive());
  const auto current = pins.received();
  REQUIRE(current.size() == 1);
  pins.request(current[0].turn);
  CHECK(rig.receive());
  CHECK(pins.received().empty());
  rig.step(sim::ExternalEcus::steps_per_tick);
  rig.ecus.begin_turn();
  const auto next = pins.received();
  REQUIRE(next.size() == 1);
  CHECK(next[0].turn == current[0].turn + 1);
}
