#include "components/node/clock.hpp"

#include <catch2/catch.hpp>

#include "components/node/peer.hpp"

namespace {

constexpr std::int64_t ms = 1'000'000, second = 1000 * ms;
constexpr std::int64_t wall_ns = 1'700'000'000 * second;

/// Messages every 2 ms that arrive at once, until a step of the sender's clock.
struct Stream {
  erp::SteadyTime time;
  std::int64_t stamp_ns = wall_ns, arrival_ns = 5 * second, last_ns = 0;
  void next(std::int64_t step_ns = 0, std::int64_t delay_ns = 0) {
    stamp_ns += 2 * ms + step_ns, arrival_ns += 2 * ms;
    last_ns = time.add(stamp_ns, arrival_ns + delay_ns);
  }
};

}  // namespace

TEST_CASE(
    "steady time advances by 2 ms per message when the clock is set back by 5 s or forward by 3 "
    "s") {
  Stream stream;
  stream.next();
  for (const std::int64_t step_s : {0, -5, 3, 0, -2, 4}) {
    const auto before_ns = stream.last_ns;
    stream.next(step_s * second);
    CHECK(stream.last_ns - before_ns == 2 * ms);
    CHECK(stream.time.step_ns() == step_s * second);
  }
  CHECK(stream.time.shift_ns() == 0);
}

TEST_CASE("late messages and a gap of 1 s without messages are not steps of the clock") {
  Stream stream;
  for (int k = 0; k < 10; ++k) stream.next(0, k * 30 * ms);
  const auto before_ns = stream.last_ns;
  stream.stamp_ns += second, stream.arrival_ns += second;
  stream.next();
  CHECK(stream.last_ns - before_ns == second + 2 * ms);
  CHECK(stream.time.shift_ns() == 0);
}

TEST_CASE("stamps are kept where the times of arrival do not advance") {
  erp::SteadyTime time;
  for (std::int64_t k = 0; k < 5; ++k)
    CHECK(time.add(wall_ns + k * second, k) == wall_ns + k * second);
}

TEST_CASE("an interval is between 0 and its limit of 0.1 s") {
  node::Interval interval;
  CHECK(interval.add_s(wall_ns, 0) == 0);
  CHECK(interval.add_s(wall_ns + 2 * ms, 2 * ms) == Approx(0.002));
  CHECK(interval.add_s(wall_ns - 5 * second, 4 * ms) == Approx(0.002));
  CHECK(interval.add_s(wall_ns - 3 * second, 2 * second) == Approx(0.1));
}

TEST_CASE("an active process does not yield to one that claims to be older") {
  node::Peer running = node::own_peer("plant", "arm", node::plant_role);
  node::Peer other = running;
  other.pid += 1, other.joined_ns = 1;
  running.active = true;
  CHECK_FALSE(node::yields_to(running, other));
  CHECK(node::yields_to(other, running));
  other.active = true;
  CHECK_FALSE(node::yields_to(running, other));
}

TEST_CASE("of two processes that start together, exactly the later one yields") {
  node::Peer first = node::own_peer("plant", "arm"), second_peer = first;
  second_peer.joined_ns += 1, second_peer.pid += 1;
  CHECK(node::yields_to(second_peer, first));
  CHECK_FALSE(node::yields_to(first, second_peer));
}

TEST_CASE("two devices of a robot are duplicates whatever their names, two controllers are not") {
  const node::Peer sim = node::own_peer("sim", "arm", node::device_role);
  node::Peer gateway = node::own_peer("gateway", "arm", node::device_role);
  gateway.pid += 1;
  CHECK(node::are_duplicates(sim, gateway));
  gateway.robot = "leg";
  CHECK_FALSE(node::are_duplicates(sim, gateway));
  node::Peer left = node::own_peer("left", "arm"), right = node::own_peer("right", "arm");
  right.pid += 1;
  CHECK_FALSE(node::are_duplicates(left, right));
}

TEST_CASE("user data of a participant contains its role and whether it is active") {
  node::Peer peer = node::own_peer("sim_2", "arm", node::device_role);
  peer.active = true;
  const auto parsed = node::parse_peer(node::to_user_data(peer));
  CHECK(parsed.role == "device");
  CHECK(parsed.active);
  CHECK(node::parse_peer("component=plant;robot=arm;").role == "plant");
}
