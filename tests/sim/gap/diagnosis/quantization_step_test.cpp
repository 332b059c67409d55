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

TEST_CASE("steps coarser than the data sheet's are seen in the readings") {
  auto blind = nothing_hidden();
  CHECK(coarse_sensors(episodes(blind, 3, 1), hinge_rig()).empty());
  blind.hidden_effects.chains[1].current.step = 0.2;
  const auto coarse = coarse_sensors(episodes(blind, 3, 1), hinge_rig());
  REQUIRE(coarse.size() == 1);
  CHECK(sim::effects::about(coarse[0].effect).type == "sensor_current_quantisation");
  CHECK(coarse[0].on == "extensor");
  const Diagnosis d = diagnose(hinge_rig(), episodes(blind));
  CHECK(d.verdict == Verdict::supported);
  CHECK(d.answer.at(0).type == "sensor_current_quantisation");
  CHECK(d.answer.size() == 1);
}

TEST_CASE("a sensor with coarse steps is named beside constants that are all a little off") {
  auto blind = nothing_hidden();
  blind.hidden_effects.chains[1].tension.step = 0.83;
  blind.built = sim::blind::as_built(hinge_rig(), 0.02, 43, blind.hidden_effects);
  const Diagnosis d = diagnose(hinge_rig(), episodes(blind, 10));
  CHECK(d.verdict == Verdict::supported);
  REQUIRE(d.answer.size() == 1);
  CHECK(d.answer[0].type == "sensor_tension_quantisation");
  CHECK_FALSE(d.constants.empty());
}

TEST_CASE("a few readings anywhere are on no lattice, as many on one are") {
  std::mt19937_64 random(1);
  for (const unsigned count : {14, 20, 40, 200})
    for (int k = 0; k < 50; ++k) {
      Signal anywhere, on_one;
      for (unsigned n = 0; n < 4 * count; ++n) on_one.push_back(7.0 * double(random() % count));
      for (unsigned n = 0; n < count; ++n) anywhere.push_back(double(random() % (30 * count)));
      const Signal* readings[] = {&anywhere};
      CHECK(quantization_step(readings, 1) < 1.8);
      readings[0] = &on_one;
      CHECK(quantization_step(readings, 1) == Approx(7).margin(0.1));
    }
}

TEST_CASE("a motion at one steady speed here and another there is on no lattice") {
  Signal said;
  double at = 0, counts_per_row = 0;
  for (int k = 0; k < 1800; ++k) {
    const double steady = k < 1000 ? 108.1 : k < 1400 ? 131.7 : 75.3;
    counts_per_row += std::clamp(steady - counts_per_row, -0.6, 0.6);
    said.push_back(std::round(at += counts_per_row));
  }
  const Signal* readings[] = {&said};
  CHECK(quantization_step(readings, 1) < 1.8);
}

TEST_CASE("where nothing can be judged, readings that look coarse explain nothing") {
  auto blind = nothing_hidden();
  blind.hidden_effects.chains[1].current.step = 0.03;
  const auto short_ones = episodes(blind, 0.3, 1);
  REQUIRE_FALSE(coarse_sensors(short_ones, hinge_rig()).empty());
  CHECK(diagnose(hinge_rig(), short_ones).verdict == Verdict::not_identifiable);
}
