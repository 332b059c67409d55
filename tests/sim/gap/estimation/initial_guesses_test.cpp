#include "sim/gap/estimation/initial_guesses.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "sim/gap/estimation/estimate.hpp"
#include "tests/sim/gap/diagnosis/blind_recording.hpp"

using namespace sim::estimation;
using sim::effects::JointEarlyStop;

namespace {

std::vector<sim::residuals::Episode> with_early_stop(double early_min_rad) {
  auto blind = blind_recording::nothing_hidden();
  blind.hidden_effects.joints[0].early_min_rad = early_min_rad;
  return blind_recording::episodes(blind, 20);
}

}  // namespace

TEST_CASE(
    "initial guesses of stops are the extreme angles of the recordings, on one side or on both") {
  const erp::Robot robot = blind_recording::hinge_rig();
  const auto recordings = blind_recording::episodes(blind_recording::nothing_hidden());
  double low = 10, high = -10;
  for (const auto& r : recordings)
    for (const double angle : r.joints[0].angle_rad)
      if (!std::isnan(angle)) low = std::min(low, angle), high = std::max(high, angle);
  const auto guesses = initial_guesses({"elbow", JointEarlyStop{}}, robot,
                                       {&recordings[0], &recordings[1], &recordings[2]});
  REQUIRE(guesses.size() == 15);
  const erp::Joint joint = robot.joints()[0];
  const auto stop = [&](std::size_t k) { return std::get<JointEarlyStop>(guesses[k].effect); };
  CHECK(stop(0).from_min_rad == Approx(low - joint.min_rad).margin(1e-9));
  CHECK(stop(0).from_max_rad == 0);
  CHECK(stop(1).from_min_rad == 0);
  CHECK(stop(1).from_max_rad == Approx(joint.max_rad - high).margin(1e-9));
  CHECK(stop(2).from_min_rad == stop(0).from_min_rad);
  CHECK(stop(2).from_max_rad == stop(1).from_max_rad);
  CHECK(stop(5).from_min_rad > stop(2).from_min_rad);
  CHECK(initial_guesses({"elbow", *sim::effects::neutral("joint_coulomb")}, robot, {&recordings[0]})
            .empty());
}

TEST_CASE(
    "an early stop of 0.6 rad is identified within an interval narrower than 0.15 rad each way") {
  const double truth = 0.6;
  const erp::Robot robot = blind_recording::hinge_rig();
  const auto recordings = with_early_stop(truth);
  const Estimator estimator(robot, recordings);
  const Uncertain uncertain{robot, constants_of(robot)};
  Point start;
  start.effects = {{"elbow", JointEarlyStop{.from_min_rad = truth + 0.01}}};
  const Estimate e = estimator.run(uncertain, start);
  const double sigma = e.sigma(uncertain.constants.size());
  const double value = std::get<JointEarlyStop>(e.point.effects[0].effect).from_min_rad;
  INFO(value << " ± " << 1.96 * sigma);
  CHECK(std::abs(value - truth) < 1.96 * sigma);
  CHECK(1.96 * sigma < 0.15);
}
