#include "sim/model/actuator/tendon.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "tests/sim/rigs.hpp"

using sim::TendonLaw;

namespace {

TendonLaw law(double pretension_N = 0) {
  erp::Tendon tendon = rigs::hinge_tendon();
  tendon.pretension_N = pretension_N;
  return TendonLaw::at_rest(tendon, {{}, rigs::spindle_radius_m}, 0.3);
}

/// A mass hanging on the tendon, with a fixed shaft: m ẍ = m g − F, x downwards.
struct HangingMass {
  double mass_kg, x_m = 0, v_m_per_s = 0;
  void run(const TendonLaw& tendon, double t_s, double dt_s = 1e-5) {
    for (double t = 0; t < t_s; t += dt_s) {
      const double force = tendon.tension_N(0.3 + x_m, v_m_per_s, 0, 0);
      v_m_per_s += dt_s * (9.81 - force / mass_kg);
      x_m += dt_s * v_m_per_s;
    }
  }
};

}  // namespace

TEST_CASE("the initial tension is the pretension") {
  CHECK(law(7).tension_N(0.3, 0, 0, 0) == Approx(7));
}

TEST_CASE("winding up stretches the tendon by the spindle radius times the angle") {
  CHECK(law().tension_N(0.3, 0, 1.0, 0) == Approx(6000 * 0.0045));
  CHECK(law().tension_N(0.3, 0, 1.0, 2.0) == Approx(6000 * 0.0045 + 20 * 0.0045 * 2));
  CHECK(law().line_m(1.0) == Approx(-0.0045));
}

TEST_CASE("a slack tendon has zero tension") {
  CHECK(law().tension_N(0.29, 0, 0, 0) == 0.0);
  CHECK(law().tension_N(0.29, 5.0, 0, 0) == 0.0);
  CHECK(law().tension_N(0.3001, -5.0, 0, 0) == 0.0);
}

TEST_CASE("a hanging mass is at rest at the stretch m g / κ") {
  HangingMass mass{2.0};
  mass.run(law(), 8.0);
  CHECK(mass.x_m == Approx(2.0 * 9.81 / 6000).epsilon(1e-6));
}

TEST_CASE("a hanging mass oscillates at √(κ/m − (D/2m)²) and decays at D/2m") {
  HangingMass mass{2.0};
  mass.run(law(), 8.0);
  const double rest = mass.x_m, dt = 1e-5;
  mass.x_m += 1e-3;
  double previous = mass.x_m - rest, first = 0, last = 0;
  int crossings = 0;
  for (int k = 0; crossings < 21; ++k) {
    mass.run(law(), 0.5 * dt, dt);
    const double offset_m = mass.x_m - rest;
    if (previous > 0 && offset_m <= 0)
      last = dt * (k + previous / (previous - offset_m)), ++crossings;
    if (crossings == 1 && first == 0) first = last;
    previous = offset_m;
  }
  const double omega = std::sqrt(6000 / 2.0 - 25.0);
  CHECK(2 * std::numbers::pi * 20 / (last - first) == Approx(omega).epsilon(1e-4));
}

TEST_CASE(
    "stretch_m and force_N of a stiffening spring on an elastic line are inverse, and the slope is "
    "the derivative") {
  for (const double cubic : {0.0, 1e6, 3e8})
    for (const double compliance : {0.0, 1e-6, 1e-4}) {
      const sim::Spring spring{2000, cubic, compliance};
      for (const double force : {0.0, 1e-3, 2.0, 40.0, 900.0}) {
        const double x = spring.stretch_m(force), h = 1e-7;
        CAPTURE(cubic, compliance, force);
        CHECK(spring.force_N(x) == Approx(force).epsilon(1e-12).margin(1e-12));
        const double slope = (spring.force_N(x + h) - spring.force_N(std::max(0.0, x - h))) /
                             (x > h ? 2 * h : x + h);
        CHECK(spring.slope_N_per_m(x) == Approx(slope).epsilon(1e-4));
      }
    }
}

TEST_CASE("a linear spring in series with a line has the stiffness κ κ_line / (κ + κ_line)") {
  erp::Tendon tendon = rigs::hinge_tendon();
  tendon.line_stiffness_N_per_m = 3000;
  CHECK(sim::Spring::of(tendon).force_N(0.01) == Approx(0.01 * 6000 * 3000 / 9000));
  CHECK(sim::Spring::of(tendon).force_N(-0.01) == 0);
  tendon.cubic_N_per_m3 = 1e8;
  CHECK(sim::Spring::of(tendon).stretch_m(6000 * 0.01 + 1e8 * 1e-6) == Approx(0.01 + 160.0 / 3000));
}
