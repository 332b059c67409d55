// One actuator channel of a blind plant: motor, gearbox, spindle, tendon. Symbols: gear ratio n,
// shaft speed ω, output torque X of the gearbox, bristle deflection s.
//   motor    L di/dt = u − R i − K_E n ω
//   gearbox  (J n² + J_g/e) dω/dt = n (K_T i − friction) − X/e,  e = η^(s sgn X)
//   spindle  stretch = path + wound length − rest length
//   tendon   F = k x + c x³ + d dx/dt, at the motor F exp(μ θ s)
#include <cmath>

#include "sim/gap/blind/plant.hpp"
#include "sim/gap/blind/state.hpp"

namespace sim::blind {

namespace c = channel_state;

namespace {

// Travel and damping of the bristles; chosen: small against the motion, resolved by the
// integrator's step.
constexpr double shaft_travel_rad = 3e-4, shaft_damping_s = 2e-3, line_travel_m = 4e-5;
constexpr double max_shaft_deflection = 1.2;  // of a bristle with its damping; chosen
constexpr double line_damping_N_s_per_m = 5;  // at least; chosen: stable integration
// A steel spindle of 4.5 mm with the last gear wheel. The teeth are stiff, not rigid.
constexpr double spindle_kg_m2 = 1e-6, tooth_Nm_per_rad = 120, tooth_damping_s = 1.7e-4;
constexpr double spindle_dry_Nm = 0.003;  // part of the gearbox friction after the play; chosen
constexpr double spindle_still_rad_per_s = 0.02;  // below, its friction decreases to 0; chosen
constexpr double copper_per_K = 0.00393;  // temperature coefficient of the resistance of copper
constexpr double snag_width_m = 0.004;    // chosen
constexpr double cogging_periods = 12;    // per turn of the motor; as in the library of effects

double dead_zone(double x, double low, double high) {
  return x > high ? x - high : x < low ? x - low : 0;
}

/// Rate of the stress of a sliding element: a spring up to its yield force, with a smooth
/// transition.
double slide_rate(double stress, double rate, double stiffness, double yield) {
  const bool loading = stress * rate > 0;
  const double used_fraction = std::abs(stress) / yield;
  return stiffness * rate * (loading ? std::max(0.0, 1 - std::pow(used_fraction, 8)) : 1);
}

}  // namespace

double Plant::spring_N(const Channel& k, double stretch_m) const {
  if (stretch_m <= 0) return 0;
  const auto spring = [&](double x) { return k.spring_N_per_m * x + k.cubic_N_per_m3 * x * x * x; };
  double force = spring(stretch_m);
  if (k.line_m_per_N > 0) {  // Newton steps for x + c F(x) = Δx, with the compliance c of the line
    double x = stretch_m / (1 + k.line_m_per_N * k.spring_N_per_m);
    for (int n = 0; n < 20; ++n) {
      const double error = x + k.line_m_per_N * spring(x) - stretch_m;
      x -= error / (1 + k.line_m_per_N * (k.spring_N_per_m + 3 * k.cubic_N_per_m3 * x * x));
      if (std::abs(error) < 1e-13) break;
    }
    force = spring(x);
  }
  return force;
}

Plant::Line Plant::pull_tendon(Channel& k, const double* x, double path_rate, double* dx) const {
  const ChannelEffects& q = k.q;
  const double shaft = k.two_masses ? x[c::spindle] : x[c::shaft];
  const double speed = k.two_masses ? x[c::spindle_speed] : x[c::speed];
  const double wound = k.radius_m * shaft + q.growth_m_per_rad * shaft * shaft / 2 +
                       q.eccentricity_m * (std::cos(shaft) - 1);
  const double wound_slope =
      k.radius_m + q.growth_m_per_rad * shaft - q.eccentricity_m * std::sin(shaft);
  const double change = k.shape.length_m - k.initial_length_m;
  const double path =
      k.shape.length_m + q.moment_arm * change + q.moment_arm_per_m * change * change / 2;
  const double path_slope = 1 + q.moment_arm + q.moment_arm_per_m * change;
  const double stretch = path + q.length_offset_m - k.rest_length_m + wound - x[c::slip];
  const double rate = path_slope * path_rate + wound_slope * speed;  // without slip, which is slow

  double force = spring_N(k, stretch) + k.damping_N_s_per_m * rate;
  if (q.line_m_per_N > 0) {  // Δx = x + c l/l₀ F, F = spring(x) + d ẋ; the wound part is rigid
    const double free_length = (k.shape.length_m - stretch) / k.initial_length_m;
    force = std::max(0.0, stretch - x[c::inner]) / (q.line_m_per_N * free_length);
    dx[c::inner] =
        (force - spring_N(k, x[c::inner])) / std::max(k.damping_N_s_per_m, line_damping_N_s_per_m);
  }
  const double taut_stretch = std::max(0.0, stretch);
  force += q.creep_N_per_m * (taut_stretch - x[c::crept]);
  if (q.hysteresis_N > 0) force += x[c::slide1] + x[c::slide2] + x[c::slide3];
  if (q.slack_N > 0) force -= q.slack_N * (1 - std::exp(-stretch / q.slack_m));
  force = stretch > 0 ? std::max(0.0, force) : 0.0;

  dx[c::crept] = (taut_stretch - x[c::crept]) / q.creep_s;
  if (q.hysteresis_N > 0)
    for (std::size_t n = 0; n < 3; ++n) {
      const double yield = q.hysteresis_N / 3;
      const double travel = q.hysteresis_m * (n == 0 ? 0.4 : n == 1 ? 1 : 2);
      dx[c::slide1 + n] =
          slide_rate(x[c::slide1 + n], stretch > 0 ? rate : 0, yield / travel, yield);
    }
  dx[c::slip] = q.slip_per_N * force * std::abs(wound_slope * speed);

  const double line_speed = wound_slope * speed;
  dx[c::line_bristle] = bristle_rate(x[c::line_bristle], line_speed, line_travel_m);
  const double bend = bend_rad(k.shape);
  double motor_side = force * std::exp(q.capstan * bend * x[c::line_bristle]);
  if (q.snag_N > 0) {
    const double distance = (change - q.snag_m) / snag_width_m;
    motor_side += q.snag_N * std::exp(-distance * distance) * x[c::line_bristle];
  }
  return {force, path_slope, std::max(0.0, motor_side), wound_slope};
}

void Plant::turn_motor(const Channel& k, const double* x, const Line& line, double voltage_V,
                       double* dx) const {
  const ChannelEffects& q = k.q;
  const erp::MotorType& m = k.motor;
  const double n = m.gear_ratio, omega = x[c::speed], s = x[c::bristle];
  const double duty = voltage_V / m.supply_V;
  const double volts =
      dead_zone(voltage_V, -q.dead_V, q.dead_V) - duty * duty * q.source_ohm * x[c::current];
  const double ohm = m.resistance_ohm * (1 + copper_per_K * x[c::heat]);
  dx[c::current] =
      (volts - ohm * x[c::current] - m.back_emf_V_s_per_rad * n * omega) / m.inductance_H;
  dx[c::heat] = q.kelvin_per_W > 0
                    ? (ohm * x[c::current] * x[c::current] * q.kelvin_per_W - x[c::heat]) / q.heat_s
                    : 0;

  dx[c::bristle] = bristle_rate(s, omega, shaft_travel_rad);
  const double deflection =
      std::clamp(s + shaft_damping_s * dx[c::bristle], -max_shaft_deflection, max_shaft_deflection);
  double load = line.wound_slope_m * line.motor_side_N;
  if (k.two_masses) {
    const double low = q.backlash_rad > 0 ? -q.backlash_rad : 0.0;
    const double stiff = q.shaft_rad_per_Nm > 0 ? 1 / q.shaft_rad_per_Nm : tooth_Nm_per_rad;
    const double twist = dead_zone(x[c::shaft] - x[c::spindle], low, 0);
    const double damping = twist != 0 ? tooth_damping_s * stiff * (omega - x[c::spindle_speed]) : 0;
    const double carried = stiff * twist + damping;
    const double direction = std::tanh(x[c::spindle_speed] / spindle_still_rad_per_s);
    dx[c::spindle] = x[c::spindle_speed];
    dx[c::spindle_speed] = (carried - load - spindle_dry_Nm * direction) / spindle_kg_m2;
    load = carried;
  }
  double dry = m.gear_coulomb_Nm + q.dry_Nm - (k.two_masses ? spindle_dry_Nm : 0) +
               (deflection > 0 ? q.asymmetric_Nm : -q.asymmetric_Nm);
  dry += q.load_fraction * std::abs(load);
  dry += q.stribeck_Nm * std::exp(-std::abs(omega / q.stribeck_rad_per_s));
  dx[c::aged] =
      (1 - x[c::aged]) / q.stiction_rest_s - std::abs(omega) * x[c::aged] / q.stiction_travel_rad;
  dry += q.stiction_Nm * x[c::aged];
  const double turned = q.turn_periods * x[c::shaft];
  dry += q.turn_sine_Nm * std::sin(turned) + q.turn_cosine_Nm * std::cos(turned);
  const double tooth = q.tooth_Nm * std::pow(0.5 + 0.5 * std::cos(x[c::shaft]), 8);
  dry = std::max(0.0, dry + tooth);
  const double output =
      std::max(0.0, m.gear_viscous_Nm_s_per_rad + q.viscous) * omega + dry * deflection + load;
  const double flow = output >= 0 ? deflection : -deflection;  // of power: 1 forward, −1 backward
  const double e = std::pow(m.gear_efficiency, std::clamp(flow, -1.0, 1.0));
  const double kt = m.torque_Nm_per_A / (1 + q.saturation_per_A2 * x[c::current] * x[c::current]);
  const double phase = cogging_periods * n * x[c::shaft];
  const double cog = q.cog_sine_Nm * std::sin(phase) + q.cog_cosine_Nm * std::cos(phase);
  const double drive = n * (kt * x[c::current] - m.rotor_viscous_Nm_s_per_rad * n * omega -
                            m.rotor_coulomb_Nm * deflection - cog);
  const double inertia = m.rotor_inertia_kg_m2 * n * n + m.gear_inertia_kg_m2 / e;
  dx[c::shaft] = omega;
  dx[c::speed] = (drive - output / e) / inertia;
}

void Plant::filter_readings(const Channel& k, const double* x, const Line& line, double* dx) const {
  const auto follow = [&](std::size_t reading, double value, const SensorEffects& sensor) {
    dx[reading] = sensor.lag_s > 0 ? (value - x[reading]) / sensor.lag_s : 0;
  };
  follow(c::reading_shaft, x[c::shaft], k.q.shaft);
  follow(c::reading_current, x[c::current], k.q.current);
  follow(c::reading_tension, line.tension_N, k.q.tension);
}

}  // namespace sim::blind
