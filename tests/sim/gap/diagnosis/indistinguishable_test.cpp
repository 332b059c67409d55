#include "sim/gap/diagnosis/indistinguishable.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "tests/sim/gap/residuals/rig_recording.hpp"
#include "tests/sim/rigs.hpp"

using namespace sim::diagnosis;
using namespace sim::residuals;

namespace {

bool has(const std::vector<Indistinguishable>& all, const std::string& hidden,
         const std::string& other) {
  return std::ranges::any_of(all, [&](const Indistinguishable& pair) {
    return sim::effects::about(pair.hidden.effect).type == hidden &&
           sim::effects::about(pair.others[0].effect).type == other &&
           pair.hidden.on == pair.others[0].on;
  });
}

}  // namespace

TEST_CASE("springs in series are indistinguishable, and friction is distinguishable from springs") {
  const erp::Robot rig = erp::read_robot(rigs::config("hinge_rig/robot.xml"));
  const Evaluator evaluator(rig, {rig_recording::record(rig, rig, {.seconds = 6})});
  const auto all = indistinguishable_effects(evaluator, 0.1);
  CHECK(has(all, "tendon_kite_line", "gearbox_shaft_compliance"));
  CHECK(has(all, "gearbox_shaft_compliance", "tendon_kite_line"));
  CHECK(has(all, "routing_pulley_radius", "routing_moment_arm"));
  for (const Indistinguishable& pair : all) {
    CHECK(sim::effects::about(pair.hidden.effect).type != "gearbox_viscous");
    CHECK(pair.hidden.on == pair.others[0].on);  // effects of different tendons are distinguishable
  }
  CHECK(indistinguishable_effects(evaluator, 1e-12).size() < all.size());
}
