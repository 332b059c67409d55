#include "sim/gap/diagnosis/split.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "sim/gap/diagnosis/diagnose.hpp"
#include "tests/sim/gap/diagnosis/blind_recording.hpp"

using namespace sim::diagnosis;
using namespace sim::residuals;
using blind_recording::episodes;
using blind_recording::hinge_rig;
using blind_recording::nothing_hidden;

namespace {

/// Three recordings; those with the indices `showing` have extra friction in a gearbox.
std::vector<Episode> with_friction(const std::vector<std::size_t>& showing) {
  auto blind = nothing_hidden();
  auto all = episodes(blind);
  blind.hidden_effects.channels[1].viscous = 0.02;
  const auto friction = episodes(blind);
  for (const std::size_t k : showing) all[k] = friction[k];
  return all;
}

}  // namespace

TEST_CASE("the recording with signals outside the range of the others is held out") {
  auto all = episodes(nothing_hidden(), 3, 3);
  for (double& n : all[1].actuators[0].tension_N) n += 800;
  const Sets sets = split(all);
  CHECK(sets.held_out == std::vector<std::size_t>{1});
  CHECK(sets.train == std::vector<std::size_t>{0, 2});
}

TEST_CASE("if two recordings show the gap, one is used for training and one is held out") {
  for (const std::size_t without_gap : {0u, 1u, 2u}) {
    std::vector<std::size_t> showing{0, 1, 2};
    showing.erase(showing.begin() + std::ptrdiff_t(without_gap));
    const Evaluator evaluator(hinge_rig(), with_friction(showing));
    Sets given;
    given.held_out = {without_gap};
    given.train = showing;
    const Sets sets = hold_out_visible(given, evaluator, {});
    REQUIRE(sets.held_out.size() == 1);
    CHECK(sets.held_out[0] != without_gap);
    CHECK(sets.train.size() == 2);
    CHECK(cuts(sets, evaluator, {}).empty());
  }
}

TEST_CASE("the two parts of a split recording contain each window exactly once") {
  auto all = with_friction({0, 1, 2});
  Sets sets{{0, 1}, {2}};
  const std::size_t windows =
      Evaluator(hinge_rig(), all).nominal_evaluation().of_episode[0].rows.size();
  const std::size_t row = all[0].rows / 3;
  cut_in_two({0, row, sim::effects::Stage::gearbox, "extensor"}, all, sets);
  CHECK(sets.train == std::vector<std::size_t>{1, 0});
  CHECK(sets.held_out == std::vector<std::size_t>{2, 3});
  const Evaluator evaluator(hinge_rig(), all);
  const auto &first = evaluator.nominal_evaluation().of_episode[0].rows,
             &second = evaluator.nominal_evaluation().of_episode[3].rows;
  CHECK(first.back() < row);
  CHECK(second.front() >= row);
  CHECK(first.size() + second.size() == windows);
}

TEST_CASE(
    "an early stop in only one recording is identified within 0.02 rad, and this recording is "
    "split") {
  auto blind = nothing_hidden();
  auto all = episodes(blind, 20);
  blind.hidden_effects.joints[0].early_min_rad = 0.6;
  all[0] = episodes(blind, 20)[0];
  const Diagnosis d = diagnose(hinge_rig(), all);
  CHECK(d.verdict == Verdict::supported);
  REQUIRE(d.answer.size() == 1);
  CHECK(d.answer[0].type == "joint_early_stop");
  CHECK(d.answer[0].values[0] == Approx(0.6).margin(0.02));
  CHECK(d.answer[0].values[1] == 0);  // the other stop was not reached
  CHECK(std::ranges::count(d.train, "recording 1") == 1);
  CHECK(std::ranges::count(d.held_out, "recording 1") == 1);
  CHECK(d.recordings.size() == 3);
  REQUIRE(d.split_recordings.size() == 1);
  CHECK(d.split_recordings[0].recording == "recording 1");
  CHECK(d.split_recordings[0].judged_from_s > 0);
  REQUIRE(d.warnings.size() == 1);
  CHECK_THAT(d.warnings[0], Catch::Contains("recording 1") && Catch::Contains("record another"));
}

TEST_CASE(
    "an early stop in only the held-out recording is identified although constants deviate by 2 to "
    "4 %") {
  auto blind = nothing_hidden();
  auto all = episodes(blind, 20);
  const std::size_t with_stop = split(all).held_out[0];
  blind.hidden_effects.joints[0].early_min_rad = 0.6;
  all[with_stop] = episodes(blind, 20)[with_stop];
  erp::Robot described = hinge_rig();  // differs from the robot of the recordings
  described.motor_types[0].resistance_ohm *= 1.03;
  for (erp::Body& body : described.skeletons[0].bodies) body.mass_kg *= 1.04;
  for (const std::size_t a : {0, 1}) {
    described.actuators[a].spindle.radius_m *= a ? 0.98 : 1.02;
    described.actuators[a].tendon.stiffness_N_per_m *= a ? 1.02 : 0.97;
  }
  const Diagnosis d = diagnose(described, all);
  CHECK(d.verdict == Verdict::supported);
  REQUIRE(d.answer.size() == 1);
  CHECK(d.answer[0].type == "joint_early_stop");
  CHECK(d.answer[0].intervals[0].low > 0.4);
  CHECK(d.answer[0].intervals[0].low < 0.6);
  CHECK(d.answer[0].intervals[0].high > 0.6);
  CHECK(d.answer[0].intervals[0].high < 0.8);
  const std::string name = all[with_stop].name;
  CHECK(std::ranges::count(d.train, name) == 1);
  CHECK(std::ranges::count(d.held_out, name) == 1);
}

TEST_CASE("a low-pass of a joint sensor is identified, and the amplified noise is not a gap") {
  auto blind = nothing_hidden();
  blind.hidden_effects.joints[0].angle.lag_s = 0.025;
  const Diagnosis d = diagnose(hinge_rig(), episodes(blind, 10));
  CHECK(d.verdict == Verdict::supported);
  REQUIRE(d.answer.size() == 1);
  CHECK(d.answer[0].type == "sensor_joint_low_pass");
}
