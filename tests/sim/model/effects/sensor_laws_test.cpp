#include <catch2/catch.hpp>
#include <cmath>

#include "sim/model/effects/acting.hpp"
#include "sim/model/effects/all.hpp"
#include "sim/model/effects/library.hpp"

using namespace sim::effects;

TEST_CASE("undo of a sensor effect inverts read") {
  const auto round_trip = [](const auto& effect) {
    Memory there{}, back{};
    double worst = 0;
    for (int k = 0; k < 2000; ++k) {
      const SensorSample s{0.002 * k, 0.002, 128};
      const double value = std::sin(0.01 * k);
      worst =
          std::fmax(worst, std::abs(effect.undo(effect.read(value, s, there), s, back) - value));
    }
    return worst;
  };
  CHECK(round_trip(SensorOffset<Sense::tension>{2}) < 1e-12);
  CHECK(round_trip(SensorGain<Sense::current>{0.2}) < 1e-12);
  CHECK(round_trip(SensorDrift<Sense::joint>{0.01}) < 1e-12);
  CHECK(round_trip(SensorEccentricity<Sense::shaft>{0.2, 0.1}) < 1e-9);
}

TEST_CASE("undo inverts several effects on one sensor in any order") {
  const std::vector<AnyEffect> all{SensorOffset<Sense::joint>{0.1}, SensorGain<Sense::joint>{0.2},
                                   SensorDrift<Sense::joint>{0.01},
                                   SensorEccentricity<Sense::joint>{0.2, 0.1}};
  for (const AnyEffect& one : all)
    for (const AnyEffect& other : all) {
      Acting there(std::vector<Placed>{{"elbow", one}, {"elbow", other}}, "elbow", Seat::joint);
      Acting back = there;
      const SensorSample s{3, 0.002, 1};
      INFO(about(one).type << ", " << about(other).type);
      CHECK(back.undo(Sense::joint, there.read(Sense::joint, 0.7, s), s) == Approx(0.7));
    }
}

TEST_CASE(
    "a low-pass sensor has the closed-form response, and undo inverts it from the reading rate") {
  // T ẏ + y = sin w t has a closed-form solution after the transient
  constexpr double period_s = 0.002, time_constant_s = 0.02, w = 5;
  const SensorLowPass<Sense::tension> slow{time_constant_s};
  const double gain = 1 / std::hypot(1, w * time_constant_s), late = std::atan(w * time_constant_s);
  Memory memory{};
  double worst = 0;
  for (int k = 0; k < 2000; ++k) {
    const double t = period_s * k;
    const double reading = slow.read(std::sin(w * t), {t, period_s, 128}, memory);
    if (t > 1) worst = std::fmax(worst, std::abs(reading - gain * std::sin(w * t - late)));
    const double rate = gain * w * std::cos(w * t - late);
    if (t > 1)
      worst = std::fmax(
          worst, std::abs(slow.undo(reading, {t, period_s, 128, rate}, memory) - std::sin(w * t)));
  }
  CHECK(worst < 1e-4);
}
