#include "sim/gap/diagnosis/quantization_step.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <random>

#include "sim/gap/diagnosis/diagnose.hpp"
#include "tests/sim/gap/diagnosis/blind_recording.hpp"

using namespace sim::diagnosis;
using blind_recording::episodes;
using blind_recording::hinge_rig;
using blind_recording::nothing_hidden;
using sim::residuals::Signal;

TEST_CASE("a quantization step of 0.2 A is detected in the readings and explains the gap") {
  auto blind = nothing_hidden();
  CHECK(coarse_sensors(episodes(blind, 3, 1), hinge_rig()).empty());
  blind.hidden_effects.channels[1].current.step = 0.2;
  const auto coarse = coarse_sensors(episodes(blind, 3, 1), hinge_rig());
  REQUIRE(coarse.size() == 1);
  CHECK(sim::effects::about(coarse[0].effect).type == "sensor_current_quantisation");
  CHECK(coarse[0].on == "extensor");
  const Diagnosis d = diagnose(hinge_rig(), episodes(blind));
  CHECK(d.verdict == Verdict::supported);
  CHECK(d.answer.at(0).type == "sensor_current_quantisation");
  CHECK(d.answer.size() == 1);
}

TEST_CASE("a quantization step of 0.83 N is identified although all constants deviate by 2 %") {
  auto blind = nothing_hidden();
  blind.hidden_effects.channels[1].tension.step = 0.83;
  blind.built = sim::blind::as_built(hinge_rig(), 0.02, 43, blind.hidden_effects);
  const Diagnosis d = diagnose(hinge_rig(), episodes(blind, 10));
  CHECK(d.verdict == Verdict::supported);
  REQUIRE(d.answer.size() == 1);
  CHECK(d.answer[0].type == "sensor_tension_quantisation");
  CHECK_FALSE(d.constants.empty());
}

TEST_CASE("random readings have no quantization step, and multiples of 7 have a step of 7") {
  std::mt19937_64 random(1);
  for (const unsigned count : {14, 20, 40, 200})
    for (int k = 0; k < 50; ++k) {
      Signal scattered, on_steps;
      for (unsigned n = 0; n < 4 * count; ++n) on_steps.push_back(7.0 * double(random() % count));
      for (unsigned n = 0; n < count; ++n) scattered.push_back(double(random() % (30 * count)));
      const Signal* readings[] = {&scattered};
      CHECK(quantization_step(readings, 1) < 1.8);
      readings[0] = &on_steps;
      CHECK(quantization_step(readings, 1) == Approx(7).margin(0.1));
    }
}

TEST_CASE("readings at several steady speeds have no quantization step") {
  Signal readings_of_shaft;
  double position = 0, counts_per_row = 0;
  for (int k = 0; k < 1800; ++k) {
    const double steady_counts_per_row = k < 1000 ? 108.1 : k < 1400 ? 131.7 : 75.3;
    counts_per_row += std::clamp(steady_counts_per_row - counts_per_row, -0.6, 0.6);
    readings_of_shaft.push_back(std::round(position += counts_per_row));
  }
  const Signal* readings[] = {&readings_of_shaft};
  CHECK(quantization_step(readings, 1) < 1.8);
}

TEST_CASE("the verdict for a recording of 0.3 s with coarse readings is not identifiable") {
  auto blind = nothing_hidden();
  blind.hidden_effects.channels[1].current.step = 0.03;
  const auto short_recordings = episodes(blind, 0.3, 1);
  REQUIRE_FALSE(coarse_sensors(short_recordings, hinge_rig()).empty());
  CHECK(diagnose(hinge_rig(), short_recordings).verdict == Verdict::not_identifiable);
}
