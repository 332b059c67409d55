#include "sim/gap/diagnosis/evaluation.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/sim/gap/residuals/rig_recording.hpp"
#include "tests/sim/model/effects/magnitudes.hpp"
#include "tests/sim/rigs.hpp"

namespace effects = sim::effects;
using namespace sim::diagnosis;
using namespace sim::residuals;

namespace {

using rigs::hinge_rig;

effects::Placed placed(const std::string& type) {
  const auto effect = magnitudes::visible(type);
  return {magnitudes::place_in_rig(effect), effect};
}

effects::Placed larger(effects::Placed one) {
  *effects::parameters(one.effect)[0].value *= 1.2;
  return one;
}

std::vector<Episode> recordings(bool with_angle) {
  std::vector<Episode> all{rig_recording::record(hinge_rig(), hinge_rig(), {.seconds = 4})};
  if (!with_angle) all[0].joints[0] = {};
  return all;
}

/// Checks that incremental and full evaluation agree after a change of the second of two effects.
void check_incremental(const Evaluator& evaluator, const std::string& first,
                       const std::string& second) {
  INFO(second << " beside " << first);
  const std::vector<std::size_t> all{0};
  const std::vector<effects::Placed> before{placed(first), placed(second)};
  const std::vector<effects::Placed> after{before[0], larger(before[1])};
  const auto incremental =
      evaluator.whitened(evaluator.changed(evaluator.with(before, all), 1, after[1], all), 0);
  const auto full = evaluator.whitened(evaluator.with(after, all), 0);
  REQUIRE(incremental.size() == full.size());
  double largest = 0;
  for (std::size_t k = 0; k < full.size(); ++k) {
    REQUIRE(std::isnan(incremental[k]) == std::isnan(full[k]));
    if (!std::isnan(full[k])) largest = std::max(largest, std::abs(incremental[k] - full[k]));
  }
  CHECK(largest < 1e-9);
}

}  // namespace

TEST_CASE("a change of one of two effects recomputes every residual that depends on it") {
  const bool with_angle = GENERATE(true, false);
  INFO((with_angle ? "with" : "without") << " the joint's angle");
  const Evaluator evaluator(hinge_rig(), recordings(with_angle));
  for (const char* first : {"gearbox_viscous", "tendon_stiffness", "spindle_radius"})
    for (const char* second : {"motor_resistance", "tendon_stiffness", "routing_pulley_radius",
                               "sensor_tension_gain", "joint_viscous", "skeleton_mass"})
      if (std::string(first) != second) check_incremental(evaluator, first, second);
}

TEST_CASE(
    "with play in a joint sensor, a change of an effect that determines the angle recomputes all "
    "residuals") {
  const Evaluator evaluator(hinge_rig(), recordings(true));
  for (const char* second : {"tendon_stiffness", "sensor_shaft_offset", "skeleton_mass"})
    check_incremental(evaluator, "joint_play", second);
}
