#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "firmware/core/laws.h"

TEST_CASE("the length law is gain times angle error") {
  CHECK(law_length_V(40, 0.5f, 0.25f) == Approx(10));
  CHECK(law_length_V(40, 0.25f, 0.5f) == Approx(-10));
}

TEST_CASE("the current law is the sum of its three terms") {
  law_current_memory memory{1.0f, 0.1f};
  // V = 0.5 * 0.2 + (1 + 100 * 0.2 * 0.002) + 0.004 * (0.2 - 0.1) / 0.002 = 0.1 + 1.04 + 0.2
  CHECK(law_current_V(&memory, 0.5f, 100, 0.004f, 0.2f, 12, 0.002f) == Approx(1.34));
  CHECK(memory.integral_V == Approx(1.04));
  CHECK(memory.last_error_A == Approx(0.2));
}

TEST_CASE("at the voltage limit the integral of the current law is frozen and recovers at once") {
  law_current_memory memory{11.9f, 5};
  for (int i = 0; i < 1000; ++i)
    CHECK(law_current_V(&memory, 0.5f, 100, 0, 5, 12, 0.002f) == 12.0f);
  CHECK(memory.integral_V == 11.9f);
  CHECK(law_current_V(&memory, 0.5f, 100, 0, -1, 12, 0.002f) == Approx(-0.5 + 11.7));
}

TEST_CASE("the integral alone never exceeds the voltage limit") {
  law_current_memory memory{-11.9f, 0};
  CHECK(law_current_V(&memory, 0, 100, 0, -5, 12, 0.002f) == -12.0f);
  CHECK(memory.integral_V >= -12.0f);
}

TEST_CASE("the force law is prefilter times reference minus state feedback") {
  const law_force_gains gains{0.5f, 2, 0.1f, 0.3f};
  // V = 0.3 * 40 - 0.5 * 0.2 - 2 * 1.5 - 0.1 * 38 = 12 - 0.1 - 3 - 3.8
  CHECK(law_force_V(&gains, 40, 0.2f, 1.5f, 38) == Approx(5.1));
}

TEST_CASE(
    "the limited voltage keeps the steady-state current within the limit in all four quadrants") {
  const float resistance_ohm = 0.516f, back_emf = 1.472f, limit_A = 4;
  for (float speed : {-8.0f, -2.0f, 0.0f, 2.0f, 8.0f})
    for (float desired_V : {-12.0f, -1.0f, 0.0f, 1.0f, 12.0f}) {
      const float V = law_limit_current_V(desired_V, speed, resistance_ohm, back_emf, limit_A, 12);
      const float current_A = (V - back_emf * speed) / resistance_ohm;
      INFO("speed " << speed << " rad/s, desired " << desired_V << " V, given " << V);
      CHECK(std::abs(current_A) <= limit_A * 1.0001f);
      CHECK(std::abs(V) <= 12);
    }
  CHECK(law_limit_current_V(12, 0, 0.516f, 1.472f, 4, 12) == Approx(4 * 0.516));
  CHECK(law_limit_current_V(1, 0, 0.516f, 1.472f, 4, 12) == 1.0f);
}

TEST_CASE(
    "the supply voltage is never exceeded, even if only a higher voltage would limit the current") {
  CHECK(law_limit_current_V(0, 20, 0.516f, 1.472f, 4, 12) == 12.0f);
  CHECK(law_limit_current_V(0, -20, 0.516f, 1.472f, 4, 12) == -12.0f);
}
