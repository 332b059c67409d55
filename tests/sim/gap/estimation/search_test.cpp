#include "sim/gap/estimation/search.hpp"

#include <catch2/catch.hpp>

#include "sim/gap/estimation/completion.hpp"
#include "sim/model/effects/library.hpp"
#include "tests/sim/gap/diagnosis/blind_recording.hpp"

using namespace sim::estimation;
using blind_recording::hinge_rig;

namespace {

sim::effects::Placed on_flexor(const char* type) {
  return {"flexor", *sim::effects::neutral(type)};
}

}  // namespace

TEST_CASE("an effect whose interval contains its neutral value is removed if the others explain") {
  auto blind = blind_recording::nothing_hidden();
  blind.hidden_effects.channels[0].viscous = 0.02;  // flexor
  const auto recordings = blind_recording::episodes(blind, 8);
  const std::span<const sim::residuals::Episode> each(recordings);
  const erp::Robot robot = hinge_rig();
  const Estimator train(robot, each.first(2));
  const ResidualVector held_out(robot, each.last(1), 1, 2);
  const Uncertain exact = uncertain_of(robot, {}, true);
  const Search search(train, held_out, exact, {});

  const JudgedEstimate both =
      search.with({on_flexor("gearbox_viscous"), on_flexor("gearbox_stribeck")});
  REQUIRE(both.train.point.effects.size() == 2);
  const JudgedEstimate one = search.without_doubtful(both);
  REQUIRE(one.train.point.effects.size() == 1);
  CHECK(sim::effects::name_of(one.train.point.effects[0]) == "gearbox_viscous on flexor");

  // A single wrong effect is not removed because a stage is open without it.
  const JudgedEstimate wrong = search.with({on_flexor("gearbox_asymmetric")});
  CHECK(search.without_doubtful(wrong).train.point.effects.size() == 1);
}
