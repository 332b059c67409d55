#include "sim/gap/estimation/periods.hpp"

#include <catch2/catch.hpp>

#include "tests/sim/gap/diagnosis/blind_recording.hpp"

using namespace sim::estimation;
using blind_recording::hinge_rig;
using sim::effects::Placed;

namespace {

Placed neutral(const char* type) { return {"flexor", *sim::effects::neutral(type)}; }

/// The best periods of an effect that is neutral in the estimate.
std::vector<double> found(const sim::blind::Case& hidden, const char* type) {
  const erp::Robot robot = hinge_rig();
  const auto recordings = blind_recording::episodes(hidden, 8, 2);
  const Estimator train(robot, recordings);
  const Uncertain exact{robot, {}};
  return periods_of(neutral(type), robot, train.residuals(), train.run(exact, {}));
}

}  // namespace

TEST_CASE("the periods of a position-dependent friction are found from the residual") {
  sim::blind::Case hidden = blind_recording::nothing_hidden();
  auto& chain = hidden.hidden_effects.chains[0];
  chain.dry_Nm = 0.06, chain.turn_sine_Nm = 0.04, chain.turn_periods = 5;
  const auto periods = found(hidden, "gearbox_position_dependent");
  REQUIRE(periods.size() == 3);
  CHECK(std::ranges::count(periods, 5) == 1);
}

TEST_CASE("the periods of a cogging are found from the residual") {
  sim::blind::Case hidden = blind_recording::nothing_hidden();
  hidden.hidden_effects.chains[0].cog_sine_Nm = 2e-3;  // 12 per turn of the motor shaft
  const auto periods = found(hidden, "motor_cogging");
  REQUIRE(periods.size() == 3);
  CHECK(periods[0] == 12);
}

TEST_CASE("an effect without periods gives an empty list") {
  CHECK(found(blind_recording::nothing_hidden(), "gearbox_stribeck").empty());
}
