#include "sim/gap/estimation/periods.hpp"

#include <catch2/catch.hpp>

#include "tests/sim/gap/diagnosis/blind_recording.hpp"

using namespace sim::estimation;
using blind_recording::hinge_rig;
using sim::effects::Placed;

namespace {

Placed neutral_effect(const char* type) { return {"flexor", *sim::effects::neutral(type)}; }

/// The numbers of periods with the highest scores, for an effect that is neutral_effect in the estimate.
std::vector<double> best_periods(const sim::blind::Case& hidden, const char* type) {
  const erp::Robot robot = hinge_rig();
  const auto recordings = blind_recording::episodes(hidden, 8, 2);
  const Estimator train(robot, recordings);
  const Uncertain exact{robot, {}};
  return periods_of(neutral_effect(type), robot, train.residuals(), train.run(exact, {}));
}

}  // namespace

TEST_CASE("five periods per turn of a friction are among the three best numbers of periods") {
  sim::blind::Case hidden = blind_recording::nothing_hidden();
  auto& channel = hidden.hidden_effects.channels[0];
  channel.dry_Nm = 0.06, channel.turn_sine_Nm = 0.04, channel.turn_periods = 5;
  const auto periods = best_periods(hidden, "gearbox_position_dependent");
  REQUIRE(periods.size() == 3);
  CHECK(std::ranges::count(periods, 5) == 1);
}

TEST_CASE("twelve periods per turn of a cogging are the best number of periods") {
  sim::blind::Case hidden = blind_recording::nothing_hidden();
  hidden.hidden_effects.channels[0].cog_sine_Nm = 2e-3;  // 12 per turn of the motor shaft
  const auto periods = best_periods(hidden, "motor_cogging");
  REQUIRE(periods.size() == 3);
  CHECK(periods[0] == 12);
}

TEST_CASE("an effect without periods gives an empty list") {
  CHECK(best_periods(blind_recording::nothing_hidden(), "gearbox_stribeck").empty());
}
