#include <catch2/catch.hpp>
#include <cmath>

#include "sim/model/actuator/motor.hpp"
#include "tests/sim/rigs.hpp"

using rigs::caliper, rigs::spindle_radius_m;
using sim::Motor, sim::MotorState;

namespace {

/// Powers in W at one instant; `gear` is the power lost in the mesh: (T_in N − T_out) ω.
struct Powers {
  double electrical, copper, friction, gear, line;
};

Powers powers(const erp::MotorType& m, const MotorState& x, double v, double f) {
  const double i = x.current_A, w = x.speed_rad_per_s, n = m.gear_ratio;
  const double sign = w > 0 ? 1 : w < 0 ? -1 : 0;
  const double rotor =
      m.torque_Nm_per_A * i - m.rotor_viscous_Nm_s_per_rad * n * w - sign * m.rotor_coulomb_Nm;
  const double load =
      m.gear_viscous_Nm_s_per_rad * w + sign * m.gear_coulomb_Nm + spindle_radius_m * f;
  const double mesh = n * rotor * m.gear_inertia_kg_m2 + m.rotor_inertia_kg_m2 * n * n * load;
  const double e = mesh * w >= 0 ? m.gear_efficiency : 1 / m.gear_efficiency;
  const double inertia = e * m.rotor_inertia_kg_m2 * n * n + m.gear_inertia_kg_m2;
  const double torque_out = e * mesh / inertia;
  return {v * i, m.resistance_ohm * i * i,
          (m.rotor_viscous_Nm_s_per_rad * n * n + m.gear_viscous_Nm_s_per_rad) * w * w +
              (m.rotor_coulomb_Nm * n + m.gear_coulomb_Nm) * std::abs(w),
          torque_out * w * (1 / e - 1), spindle_radius_m * f * w};
}

double stored_J(const erp::MotorType& m, const MotorState& x) {
  const double inertia = m.rotor_inertia_kg_m2 * m.gear_ratio * m.gear_ratio + m.gear_inertia_kg_m2;
  return 0.5 * m.inductance_H * x.current_A * x.current_A +
         0.5 * inertia * x.speed_rad_per_s * x.speed_rad_per_s;
}

}  // namespace

TEST_CASE("the energy balance of the motor closes without gain in all four quadrants") {
  const erp::MotorType m = caliper();
  const Motor motor(m, spindle_radius_m);
  struct Quadrant {
    double speed, v, f;
  };
  // winding driven, winding braked, unwinding driven, unwinding braked by the motor; then slack,
  // short.
  const auto q = GENERATE(Quadrant{2, 8, 60}, Quadrant{6, -2, 60}, Quadrant{-2, -9, 60},
                          Quadrant{-6, 2, 90}, Quadrant{3, -6, 0}, Quadrant{-4, 0, 150});
  CAPTURE(q.speed, q.v, q.f);
  MotorState x{0, q.speed, 0};
  const double stored_before = stored_J(m, x), h = 2e-6;
  double electrical = 0, copper = 0, friction = 0, gear = 0, line = 0;
  for (int k = 0; k < 25000; ++k) {
    const MotorState middle = step(motor, x, q.v, q.f, h / 2), end = step(motor, x, q.v, q.f, h);
    const auto simpson = [&](double Powers::*p) {
      return h / 6 *
             (powers(m, x, q.v, q.f).*p + 4 * (powers(m, middle, q.v, q.f).*p) +
              powers(m, end, q.v, q.f).*p);
    };
    electrical += simpson(&Powers::electrical), copper += simpson(&Powers::copper);
    friction += simpson(&Powers::friction), line += simpson(&Powers::line);
    const double lost_in_gear = simpson(&Powers::gear);
    REQUIRE(lost_in_gear >= 0);
    gear += lost_in_gear;
    x = end;
  }
  const double residual_J =
      electrical - copper - friction - gear - line - stored_J(m, x) + stored_before;
  const double converted_J = std::abs(electrical) + copper + friction + gear + std::abs(line);
  CHECK(std::abs(residual_J) < 1e-6 * converted_J);
}

TEST_CASE("a load that drives the motor delivers the fraction η of its power") {
  erp::MotorType m = rigs::without_friction(caliper());
  const Motor motor(m, spindle_radius_m);
  // Short circuit, unwinding at constant speed: K_T i N / η = r F, electrical power R i² = η r F
  // |ω|.
  const MotorState x = step(motor, {}, 0.0, 100.0, 1.0);
  REQUIRE(x.speed_rad_per_s < 0);
  const double delivered = spindle_radius_m * 100 * -x.speed_rad_per_s;
  CHECK(0.516 * x.current_A * x.current_A == Approx(0.59 * delivered).epsilon(1e-9));
}
