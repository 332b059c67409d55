// When one ECU of a limb is lost, the limb drops to its safe actions, and no other.
#include "components/plant/limbs.hpp"

#include <catch2/catch.hpp>

#include "tests/components/plant/bench.hpp"

namespace {

using bench::ms;

constexpr std::int64_t lost_ns = 50 * ms;

/// Two muscles of an arm and one of a leg, each with an ECU of its own.
erp::Robot arm_and_leg() {
  erp::Robot robot = bench::one_muscle();
  robot.actuators.resize(3, robot.actuators[0]);
  const std::array names{"biceps", "triceps", "calf"};
  for (int k = 0; k < 3; ++k) {
    erp::Actuator& actuator = robot.actuators[std::size_t(k)];
    actuator.name = names[std::size_t(k)], actuator.ecu = k;
    actuator.limb = k < 2 ? "arm" : "leg";
  }
  return robot;
}

/// All of them pull with 20 N; the ECUs of `silent` say nothing.
void pass(plant::Plant& plant, std::int64_t now_ns, ecu_state state, int silent = -1) {
  erp::EcuFrame frame;
  erp::ActuatorCommand command;
  erp::assign(command.controller, "a");
  for (const erp::Actuator& actuator : arm_and_leg().actuators) {
    erp::EcuChannelSample channel{};
    channel.ecu = std::uint8_t(actuator.ecu), channel.fresh = actuator.ecu != silent;
    channel.state = static_cast<std::uint8_t>(state), channel.tension_counts = 819;
    erp::append(frame.channels, channel);
    erp::ActuatorReference reference{};
    erp::assign(reference.name, actuator.name);
    reference.mode = static_cast<std::uint8_t>(erp::Mode::force), reference.reference = 20;
    erp::append(command.actuators, reference);
  }
  plant.sense(frame, now_ns);
  plant.accept(command, now_ns);
}

}  // namespace

TEST_CASE("a limb is broken from when one of it was not heard for long, until it is again") {
  plant::Limbs limbs(arm_and_leg(), lost_ns);
  limbs.look(1000 * ms);
  CHECK_FALSE(limbs.broken(0));  // never heard: not there yet
  for (std::size_t k = 0; k < 3; ++k) limbs.heard(k, 1000 * ms);
  const auto later = 1000 * ms + lost_ns;
  for (const std::size_t k : {0, 2}) limbs.heard(k, later - ms);
  limbs.look(later - 1);
  CHECK_FALSE(limbs.broken(0));
  limbs.look(later);
  CHECK(limbs.lost(1));
  CHECK_FALSE(limbs.lost(0));
  CHECK((limbs.broken(0) && limbs.broken(1)));
  CHECK_FALSE(limbs.broken(2));
  limbs.heard(1, later + ms);
  limbs.look(later + ms);
  CHECK_FALSE(limbs.broken(0));
}

TEST_CASE("what pulls against a lost muscle relaxes though its controller speaks on") {
  plant::Plant plant({}, arm_and_leg());
  std::int64_t now_ns = 1000 * ms;
  pass(plant, now_ns, ECU_STATE_ARMED);
  const auto asked_after = [&](int ticks, int silent) {
    for (int k = 0; k < ticks; ++k) {
      pass(plant, now_ns += 2 * ms, ECU_STATE_RUNNING, silent);
      plant.command(now_ns);
    }
    const auto& channels = plant.command(now_ns).channels;
    return std::array{channels._buffer[0].setpoint, channels._buffer[1].setpoint,
                      channels._buffer[2].setpoint};
  };
  CHECK(asked_after(3, -1) == std::array{20000, 20000, 20000});
  CHECK(asked_after(20, 1)[0] == 20000);  // 40 ms
  const auto broken = asked_after(10, 1);
  CHECK(broken[0] == 2000);
  CHECK(broken[2] == 20000);
  CHECK(plant.owners().actuators._buffer[0].safe_action ==
        static_cast<std::uint8_t>(erp::SafeAction::relax));
  CHECK(asked_after(3, -1)[0] == 20000);
}
