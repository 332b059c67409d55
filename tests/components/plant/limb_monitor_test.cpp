// When one ECU of a limb is lost, only the actuators of that limb take their safe action.
#include "components/plant/limb_monitor.hpp"

#include <catch2/catch.hpp>

#include "tests/components/plant/bench.hpp"

namespace {

using bench::ms;

constexpr std::int64_t lost_ns = 50 * ms;

/// Two actuators of an arm and one of a leg, each with its own ECU.
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

/// One period: every actuator is commanded 20 N; the ECU `silent` does not report.
void step(plant::Plant& plant, std::int64_t now_ns, ecu_state state, int silent = -1) {
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
  plant.receive(command, now_ns);
}

}  // namespace

TEST_CASE("a limb is degraded from 50 ms after the last sample of one ECU until its next sample") {
  plant::LimbMonitor monitor(arm_and_leg(), lost_ns);
  monitor.update(1000 * ms);
  CHECK_FALSE(monitor.degraded(0));  // no sample yet: the ECU has not started
  for (std::size_t k = 0; k < 3; ++k) monitor.on_sample(k, 1000 * ms);
  const auto later = 1000 * ms + lost_ns;
  for (const std::size_t k : {0, 2}) monitor.on_sample(k, later - ms);
  monitor.update(later - 1);
  CHECK_FALSE(monitor.degraded(0));
  monitor.update(later);
  CHECK(monitor.lost(1));
  CHECK_FALSE(monitor.lost(0));
  CHECK((monitor.degraded(0) && monitor.degraded(1)));
  CHECK_FALSE(monitor.degraded(2));
  monitor.on_sample(1, later + ms);
  monitor.update(later + ms);
  CHECK_FALSE(monitor.degraded(0));
}

TEST_CASE("the antagonist of a lost actuator relaxes while its controller keeps commanding") {
  plant::Plant plant({}, arm_and_leg());
  std::int64_t now_ns = 1000 * ms;
  step(plant, now_ns, ECU_STATE_ARMED);
  const auto setpoints_after = [&](int ticks, int silent) {
    for (int k = 0; k < ticks; ++k) {
      step(plant, now_ns += 2 * ms, ECU_STATE_RUNNING, silent);
      plant.command(now_ns);
    }
    const auto& channels = plant.command(now_ns).channels;
    return std::array{channels._buffer[0].setpoint, channels._buffer[1].setpoint,
                      channels._buffer[2].setpoint};
  };
  CHECK(setpoints_after(3, -1) == std::array{20000, 20000, 20000});
  CHECK(setpoints_after(20, 1)[0] == 20000);  // 40 ms
  const auto degraded = setpoints_after(10, 1);
  CHECK(degraded[0] == 2000);
  CHECK(degraded[2] == 20000);
  CHECK(plant.owners().actuators._buffer[0].safe_action ==
        static_cast<std::uint8_t>(erp::SafeAction::relax));
  CHECK(setpoints_after(3, -1)[0] == 20000);
}
