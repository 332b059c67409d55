#include <catch2/catch.hpp>

#include "sim/gap/estimation/as_built.hpp"
#include "tests/sim/gap/diagnosis/blind_recording.hpp"

using namespace sim::estimation;

namespace {

/// The answer for a rig with hidden effects, without the withheld types.
AsBuilt found_of(const sim::blind::Case& hidden, const std::vector<std::string>& withhold = {}) {
  const auto recordings = blind_recording::episodes(hidden, 10);
  const std::span<const sim::residuals::Episode> each(recordings);
  AsBuiltOptions options;
  options.search.withhold = withhold;
  return as_built(blind_recording::hinge_rig(), each.first(2), each.last(1), options);
}

}  // namespace

TEST_CASE(
    "a stiffness whose effect is withheld is reported as an unknown law, not as three constants") {
  auto blind = blind_recording::nothing_hidden();
  blind.hidden_effects.channels[1].spring = 0.3;  // extensor
  const AsBuilt found = found_of(blind, {"tendon_stiffness", "tendon_creep"});
  CHECK(found.unknown_law);
  CHECK(found.beyond_tolerance.empty());
}

TEST_CASE("two causes at one place are identified and not reported as an unknown law") {
  auto blind = blind_recording::nothing_hidden();
  blind.hidden_effects.channels[1].rotor = 0.66;  // extensor
  blind.hidden_effects.channels[1].turn_sine_Nm = 0.049,
  blind.hidden_effects.channels[1].turn_cosine_Nm = -0.063;
  const AsBuilt found = found_of(blind);
  CHECK_FALSE(found.has_open_stage);
  CHECK_FALSE(found.unknown_law);
  REQUIRE(found.estimate.point.effects.size() == 1);
  CHECK(sim::effects::name_of(found.estimate.point.effects[0]) ==
        "gearbox_position_dependent on extensor");
  REQUIRE(found.beyond_tolerance.size() == 1);
  CHECK(found.uncertain.constants[found.beyond_tolerance[0]].on == "extensor");
}
