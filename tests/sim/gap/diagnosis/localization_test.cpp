#include "sim/gap/diagnosis/localization.hpp"

#include <catch2/catch.hpp>

#include "sim/gap/residuals/noise_floor.hpp"
#include "tests/sim/gap/residuals/rig_recording.hpp"
#include "tests/sim/model/effects/magnitudes.hpp"
#include "tests/sim/rigs.hpp"

namespace effects = sim::effects;
using namespace sim::diagnosis;
using namespace sim::residuals;

namespace {

using rigs::hinge_rig;

/// Two recordings of a rig with these effects.
std::vector<Episode> recordings(const std::vector<effects::Placed>& placed) {
  erp::Robot real = hinge_rig();
  for (const auto& p : placed) real.effects.push_back(effects::written(p));
  return {rig_recording::record(hinge_rig(), real, {.seconds = 12, .seed = 7}),
          rig_recording::record(hinge_rig(), real,
                                {.seconds = 12, .swing_N = 12, .swing_Hz = 0.7, .seed = 8})};
}

}  // namespace

TEST_CASE(
    "without effects the residual of each stage equals its noise floor from the data sheets") {
  for (const StageGap& gap : localize(hinge_rig(), recordings({}))) {
    INFO(effects::word(gap.stage) << " " << gap.on << ": rms " << gap.rms << " " << gap.unit
                                  << ", floor " << gap.floor);
    CHECK(gap.rms < 1.35 * gap.floor);
    // The noise floor of a tendon includes a delay of the tension by half a period; here there is
    // no delay.
    CHECK(gap.rms > (gap.stage == effects::Stage::tendon ? 0.4 : 0.7) * gap.floor);
    CHECK_FALSE(gap.open);
  }
}

TEST_CASE("a small effect opens only its stage, with an interval above the noise") {
  const std::vector<std::pair<effects::Placed, std::string>> cases{
      {{"extensor", effects::MotorDeadBand{0.05}}, "motor extensor"},
      {{"flexor", effects::GearboxCoulomb{0.02}}, "gearbox flexor"},
      {{"extensor", effects::TendonStiffness{0.03}}, "tendon extensor"},
      {{"elbow", effects::JointViscous{0.03}}, "joint elbow"}};
  for (const auto& [placed, stage] : cases) {
    const auto gaps = localize(hinge_rig(), recordings({placed}));
    INFO(stage);
    CHECK(std::string(effects::word(gaps[0].stage)) + " " + gaps[0].on == stage);
    CHECK(gaps[0].open);
    CHECK(gaps[0].share > 0.8);
    CHECK(gaps[0].excess_interval.low > 0.5);
    CHECK(gaps[0].excess > gaps[0].excess_interval.low);
    CHECK(gaps[0].excess < gaps[0].excess_interval.high);
    for (std::size_t k = 1; k < gaps.size(); ++k) CHECK_FALSE(gaps[k].open);
  }
}

TEST_CASE("if the columns of every stage are missing, the error names the missing columns") {
  auto episodes = recordings({});
  for (Episode& e : episodes)
    for (auto& a : e.actuators) a.shaft_rad.clear(), a.tension_N.clear();
  CHECK_THROWS_WITH(localize(hinge_rig(), episodes), Catch::Contains("shaft_rad"));
}
