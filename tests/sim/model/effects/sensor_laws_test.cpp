#include <catch2/catch.hpp>
#include <cmath>

#include "sim/model/effects/acting.hpp"
#include "sim/model/effects/all.hpp"
#include "sim/model/effects/library.hpp"

using namespace sim::effects;

TEST_CASE("undo of a sensor effect inverts read") {
  const auto round_trip = [](const auto& effect) {
    Memory read_memory{}, undo_memory{};
    double largest_error = 0;
    for (int k = 0; k < 2000; ++k) {
      const SensorSample s{0.002 * k, 0.002, 128};
      const double value = std::sin(0.01 * k);
      largest_error = std::fmax(
          largest_error,
          std::abs(effect.undo(effect.read(value, s, read_memory), s, undo_memory) - value));
    }
    return largest_error;
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
  for (const AnyEffect& first : all)
    for (const AnyEffect& other : all) {
      Acting reading(std::vector<Placed>{{"elbow", first}, {"elbow", other}}, "elbow", Seat::joint);
      Acting undoing = reading;
      const SensorSample s{3, 0.002, 1};
      INFO(about(first).type << ", " << about(other).type);
      CHECK(undoing.undo(Sense::joint, reading.read(Sense::joint, 0.7, s), s) == Approx(0.7));
    }
}

TEST_CASE(
    "a low-pass sensor has the closed-form response, and undo inverts it from the reading rate") {
  // T ẏ + y = sin w t has a closed-form solution after the transient
  constexpr double period_s = 0.002, time_constant_s = 0.02, w = 5;
  const SensorLowPass<Sense::tension> slow{time_constant_s};
  const double gain = 1 / std::hypot(1, w * time_constant_s),
               phase_lag = std::atan(w * time_constant_s);
  Memory memory{};
  double largest_error = 0;
  for (int k = 0; k < 2000; ++k) {
    const double t = period_s * k;
    const double reading = slow.read(std::sin(w * t), {t, period_s, 128}, memory);
    if (t > 1)
      largest_error =
          std::fmax(largest_error, std::abs(reading - gain * std::sin(w * t - phase_lag)));
    const double rate = gain * w * std::cos(w * t - phase_lag);
    if (t > 1)
      largest_error = std::fmax(
          largest_error,
          std::abs(slow.undo(reading, {t, period_s, 128, rate}, memory) - std::sin(w * t)));
  }
  CHECK(largest_error < 1e-4);
}
