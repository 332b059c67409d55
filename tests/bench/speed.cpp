// Measures the duration of a step of the simulator, of a control law and of the plant, in one
// process, with Google Benchmark. --benchmark_format=json prints JSON.
#include <benchmark/benchmark.h>

#include "components/plant/plant.hpp"
#include "firmware/core/laws.h"
#include "interfaces/robot/robot.hpp"
#include "sim/world/internal_model.hpp"
#include "sim/world/virtual_ecus.hpp"
#include "sim/world/world.hpp"
#include "tests/bench/side_by_side.hpp"
#include "tests/sim/formats/mujoco.hpp"

namespace {

erp::Robot read(const std::string& robot) {
  return erp::read_robot(ERP_SOURCE_DIR "/configs/" + robot + "/robot.xml");
}

void count_steps(benchmark::State& state) {
  state.counters["steps_per_s"] =
      benchmark::Counter(static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

void step_world(benchmark::State& state, const erp::Robot& robot) {
  sim::World world(robot);
  const std::vector<double> voltage_V(world.actuators().size(), 0.1);
  for (auto _ : state) world.step(voltage_V, 0.001);
  count_steps(state);
}

void step_mujoco(benchmark::State& state, const erp::Robot& robot) {
  const reference::Mujoco peer(robot);
  for (std::size_t k = 0; k < robot.actuators.size(); ++k)
    peer.data->ctrl[k] = robot.actuators[k].tendon.pretension_N;
  for (auto _ : state) mj_step(peer.model.get(), peer.data.get());
  count_steps(state);
}

/// One physics step of 1 ms with motors and tendons, without ECUs.
void world_step(benchmark::State& state, const char* robot) { step_world(state, read(robot)); }
BENCHMARK_CAPTURE(world_step, hinge_rig, "hinge_rig");
BENCHMARK_CAPTURE(world_step, arm, "arm");
BENCHMARK_CAPTURE(world_step, ecce4, "ecce4");

/// The exported model in MuJoCo: the same bones, tendons, frictions and limits, without motors,
/// springs and spindles.
void mujoco_step(benchmark::State& state, const char* robot) { step_mujoco(state, read(robot)); }
BENCHMARK_CAPTURE(mujoco_step, hinge_rig, "hinge_rig");
BENCHMARK_CAPTURE(mujoco_step, arm, "arm");
BENCHMARK_CAPTURE(mujoco_step, ecce4, "ecce4");

/// A robot with `tendons` tendons: several arms on one torso.
erp::Robot arms(long tendons) {
  erp::Robot robot = side_by_side(read("arm"), "torso", static_cast<int>((tendons + 10) / 11));
  robot.joint_sensors.clear();
  robot.actuators.resize(static_cast<std::size_t>(tendons));
  return robot;
}

void tendons_step(benchmark::State& state) {
  step_world(state, arms(state.range(0)));
  state.SetComplexityN(state.range(0));
}
void tendons_mujoco(benchmark::State& state) {
  step_mujoco(state, arms(state.range(0)));
  state.SetComplexityN(state.range(0));
}
#define ERP_SIZES Arg(11)->Arg(22)->Arg(44)->Arg(54)->Arg(108)->Arg(216)->Complexity()
BENCHMARK(tendons_step)->ERP_SIZES;
BENCHMARK(tendons_mujoco)->ERP_SIZES;

/// 2 ms of a complete robot: firmware of all ECUs, sensors, two physics steps.
void ecu_tick(benchmark::State& state, const char* name) {
  const erp::Robot robot = read(name);
  sim::World world(robot);
  sim::VirtualEcus ecus(robot);
  for (auto _ : state) ecus.tick(world);
  state.counters["times_real_time"] = benchmark::Counter(
      0.002 * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK_CAPTURE(ecu_tick, ecce4, "ecce4");

/// Prediction of two candidates over 100 steps each, on the given number of threads.
void two_ahead(benchmark::State& state) {
  const erp::Robot robot = read("ecce4");
  sim::InternalModel model(robot, {}, static_cast<int>(state.range(0)));
  const sim::WorldState start = sim::World(robot).save();
  const std::vector<std::vector<double>> candidates(
      2, std::vector<double>(robot.actuators.size(), 0.1));
  for (auto _ : state) benchmark::DoNotOptimize(model.ahead(start, candidates, 100, 0.001));
  state.counters["steps_per_s"] = benchmark::Counter(200 * static_cast<double>(state.iterations()),
                                                     benchmark::Counter::kIsRate);
}
BENCHMARK(two_ahead)->Arg(1)->Arg(2)->UseRealTime();

void force_law(benchmark::State& state) {
  const law_force_gains gains{0.1F, 0.2F, 0.5F, 0.6F};
  float tension_N = 2;
  for (auto _ : state) {
    benchmark::DoNotOptimize(tension_N);
    benchmark::DoNotOptimize(law_force_V(&gains, 40, 0.1F, 0.2F, tension_N));
  }
}
BENCHMARK(force_law);

/// Processing of one frame and one command by the plant, for all actuators of a robot.
void plant_cycle(benchmark::State& state, const char* name) {
  const erp::Robot robot = read(name);
  plant::Plant plant({}, robot);
  erp::EcuFrame frame;
  for (const auto& actuator : robot.actuators) {
    erp::EcuChannelSample channel{};
    channel.ecu = static_cast<std::uint8_t>(actuator.ecu);
    channel.channel = static_cast<std::uint8_t>(actuator.channel);
    channel.fresh = true;
    erp::append(frame.channels, channel);
  }
  std::int64_t now_ns = 0;
  for (auto _ : state) {
    now_ns += 2'000'000;
    plant.sense(frame, now_ns);
    benchmark::DoNotOptimize(plant.command(now_ns));
  }
}
BENCHMARK_CAPTURE(plant_cycle, hinge_rig, "hinge_rig");
BENCHMARK_CAPTURE(plant_cycle, arm, "arm");

}  // namespace

BENCHMARK_MAIN();
