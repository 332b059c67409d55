#include "sim/gap/diagnosis/shapley.hpp"

#include <catch2/catch.hpp>
#include <numeric>

#include "tests/sim/gap/residuals/rig_recording.hpp"
#include "tests/sim/rigs.hpp"

using namespace sim::diagnosis;
using sim::effects::Placed;

namespace {

Placed placed(const char* type, const char* on, double value) {
  Placed p{on, *sim::effects::neutral(type)};
  *sim::effects::parameters(p.effect)[0].value = value;
  return p;
}

/// Seven effects on the rig, most of them on different stages.
std::vector<Placed> seven() {
  return {placed("motor_resistance", "flexor", 0.3),  placed("motor_resistance", "extensor", 0.3),
          placed("gearbox_viscous", "flexor", 0.02),  placed("gearbox_viscous", "extensor", 0.02),
          placed("tendon_stiffness", "flexor", -0.2), placed("tendon_stiffness", "extensor", -0.2),
          placed("joint_viscous", "elbow", 0.1)};
}

}  // namespace

TEST_CASE(
    "Shapley values of seven effects sum to 1 and agree with the exact values of six of them") {
  const erp::Robot nominal = erp::read_robot(rigs::config("hinge_rig/robot.xml"));
  erp::Robot real = nominal;
  for (const Placed& p : seven()) real.effects.push_back(sim::effects::written(p));
  const Problem problem{
      nominal, {rig_recording::record(nominal, real, {.seconds = 6})}, {}, {{0}, {0}}};
  const Evaluator evaluator(nominal, problem.episodes);
  const ShapleyValues all = shapley_values(problem, evaluator, seven());
  const double sum = std::accumulate(all.share.begin(), all.share.end(), 0.0);
  CHECK(sum == Approx(1).margin(0.02));
  for (std::size_t k = 0; k < all.share.size(); ++k) {
    INFO(k);
    CHECK(all.interval[k].low <= all.share[k]);
    CHECK(all.share[k] <= all.interval[k].high);
    CHECK(all.lost[k].low > 0);
  }
  auto six = seven();
  six.pop_back();
  const ShapleyValues exact = shapley_values(problem, evaluator, six);
  for (std::size_t k = 0; k < six.size(); ++k)
    CHECK(exact.share[k] == Approx(all.share[k]).margin(0.02));
}
