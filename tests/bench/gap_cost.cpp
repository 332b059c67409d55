// Measures the duration of a diagnosis for several numbers of actuators, numbers of effects and
// lengths of the four recordings, with Google Benchmark. --benchmark_format=json prints JSON.
#include <benchmark/benchmark.h>

#include "sim/gap/blind/record.hpp"
#include "sim/gap/diagnosis/diagnose.hpp"
#include "tests/bench/side_by_side.hpp"

namespace {

using sim::residuals::Episode;

erp::Robot read(const std::string& robot) {
  return erp::read_robot(ERP_SOURCE_DIR "/configs/" + robot + "/robot.xml");
}

/// Four recordings of a robot with viscous friction in the gearbox of its first actuator.
std::vector<Episode> recordings(const erp::Robot& robot, double seconds) {
  sim::blind::Case hidden = sim::blind::draw_case(robot, sim::blind::Kind::null, 1);
  hidden.hidden_effects.channels[0].viscous = 0.02;
  std::vector<Episode> episodes;
  std::vector<std::string> remarks;
  for (int k = 0; k < 4; ++k)
    episodes.push_back(sim::residuals::lay_out(
        sim::blind::record(robot, hidden, sim::excitation(robot, k, seconds, 5),
                           static_cast<std::uint64_t>(k)),
        robot, "recording " + std::to_string(k + 1), remarks));
  return episodes;
}

/// Returns the effects to withhold. Every `stride`-th effect of the library and the true effect
/// remain.
std::vector<std::string> effects_to_withhold(int stride) {
  std::vector<std::string> withheld;
  int n = 0;
  for (const auto& effect : sim::effects::library())
    if (const auto type = sim::effects::about(effect).type;
        n++ % stride != 0 && type != "gearbox_viscous")
      withheld.emplace_back(type);
  return withheld;
}

void diagnose(benchmark::State& state, const erp::Robot& robot, double seconds, int stride) {
  const auto episodes = recordings(robot, seconds);
  const auto withheld = effects_to_withhold(stride);
  for (auto _ : state) {
    const auto diagnosis = sim::diagnosis::diagnose(robot, episodes, {.withhold = withheld});
    if (diagnosis.verdict != sim::diagnosis::Verdict::supported)
      state.SkipWithError("the friction is not identified");
  }
  state.counters["actuators"] = static_cast<double>(robot.actuators.size());
  state.counters["effects"] = static_cast<double>(sim::effects::library().size() - withheld.size());
  state.counters["recorded_s"] = 4 * seconds;
}

void rigs(benchmark::State& state) {
  diagnose(state, side_by_side(read("hinge_rig"), "base", static_cast<int>(state.range(0))), 6, 1);
}
void effects(benchmark::State& state) {
  diagnose(state, read("hinge_rig"), 6, static_cast<int>(state.range(0)));
}
void seconds(benchmark::State& state) {
  diagnose(state, read("hinge_rig"), static_cast<double>(state.range(0)), 1);
}

#define ERP_ONCE Iterations(1)->UseRealTime()->Unit(benchmark::kSecond)
BENCHMARK(rigs)->Arg(1)->Arg(2)->Arg(4)->ERP_ONCE;
BENCHMARK(effects)->Arg(8)->Arg(4)->Arg(2)->Arg(1)->ERP_ONCE;
BENCHMARK(seconds)->Arg(6)->Arg(12)->Arg(25)->ERP_ONCE;

}  // namespace

BENCHMARK_MAIN();
