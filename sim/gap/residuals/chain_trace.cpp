#include "sim/gap/residuals/chain_trace.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/gap/residuals/held_voltage.hpp"
#include "sim/gap/residuals/signal_noise.hpp"

namespace sim::residuals {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double resting_shaft_rad_per_s = 0.02;  // chosen: an encoder step in a few rows

using effects::Sloped;

/// Computes the rows of one chain, one after the other.
class Tracer {
 public:
  Tracer(ChainModel model, const ActuatorSignals& measured, const PathTrace& path, double period_s,
         double speed_half_width_s, const ChainTrace* other)
      : m_(std::move(model)),
        in_(measured),
        path_(path),
        other_(other),
        period_s_(period_s),
        bump_(speed_half_width_s, period_s),
        law_{Spring::of(m_.actuator.tendon), m_.actuator.tendon.damping_N_s_per_m,
             m_.actuator.spindle.radius_m, 0} {
    law_.rest_m = m_.initial_length_m - law_.spring.stretch_m(m_.actuator.tendon.pretension_N);
  }

  ChainTrace run() {
    undo_sensors();
    out_.tension_measured = !in_.tension_N.empty(), out_.current_measured = !in_.current_A.empty();
    if (!out_.current_measured) out_.current_averaged = 1;
    rows_ = std::max({out_.shaft_rad.size(), in_.voltage_V.size(), in_.tension_N.size()});
    out_.speed_rad_per_s = speeds();
    const bool has_angle = !out_.shaft_rad.empty();
    if (has_angle && !path_.length_m.empty())
      out_.spring_N.assign(rows_, nan), out_.path_slope.assign(rows_, 1);
    if (has_angle && !in_.voltage_V.empty())
      out_.terminal_V.assign(rows_, nan), out_.resistance_ohm.assign(rows_, nan);
    find_driver_delay();
    samples_.reserve(rows_), wound_slope_.reserve(rows_), aged_Nm_.reserve(rows_);
    for (std::size_t k = 0; k < rows_; ++k) add_row(k);
    if (!out_.tension_measured) out_.tension_N = out_.spring_N;
    set_drive_torque();
    return std::move(out_);
  }

 private:
  void undo_sensors() {
    const auto undone = [&](effects::Sense sense, const Signal& reading) {
      Signal value = reading;
      if (m_.effects.acts_on(sense))
        for (std::size_t k = 0; k < reading.size(); ++k)
          value[k] = m_.effects.undo(sense, reading[k],
                                     {period_s_ * double(k), period_s_, m_.motor.gear_ratio,
                                      rate_of(reading, k, period_s_)});
      return value;
    };
    out_.current_averaged =
        in_.current_around
            ? 1
            : m_.effects.averaged(effects::Sense::current, {0, period_s_, m_.motor.gear_ratio, 0});
    out_.shaft_rad = undone(effects::Sense::shaft, in_.shaft_rad);
    out_.current_A = undone(effects::Sense::current, in_.current_A);
    out_.tension_N = undone(effects::Sense::tension, in_.tension_N);
  }

  /// Splits the driver's delay into whole periods and the remaining part of a period.
  void find_driver_delay() {
    const double delay_s = m_.effects.driver_delay_s();
    delay_rows_ = static_cast<std::size_t>(delay_s / period_s_);
    out_.driver_delay_s = delay_s - static_cast<double>(delay_rows_) * period_s_;
    two_periods_ = two_periods(m_.motor, period_s_, out_.driver_delay_s);
  }

  Signal speeds() const {
    const bool same = other_ && std::ranges::equal(other_->shaft_rad, out_.shaft_rad);
    return same ? other_->speed_rad_per_s : bump_.rates(out_.shaft_rad);
  }

  effects::ChainSample initial_sample() const {
    effects::ChainSample s;
    s.path_m = m_.initial_length_m;
    return s;
  }
  /// Adds the sample of row k. Missing values are those of the row before: effects need values.
  effects::ChainSample& sample(std::size_t k) {
    samples_.push_back(samples_.empty() ? initial_sample() : samples_.back());
    effects::ChainSample& s = samples_.back();
    const auto update = [&](double& value, const Signal& signal, std::size_t row) {
      if (!signal.empty() && !std::isnan(signal[row])) value = signal[row];
    };
    s.dt_s = period_s_;
    s.supply_V = m_.motor.supply_V, s.gear_ratio = m_.motor.gear_ratio;
    update(s.voltage_V, in_.voltage_V, k), update(s.current_A, out_.current_A, k);
    update(s.shaft_rad, out_.shaft_rad, k), update(s.speed_rad_per_s, out_.speed_rad_per_s, k);
    if (out_.tension_measured) update(s.tension_N, out_.tension_N, k);
    else if (k > 0) update(s.tension_N, out_.spring_N, k - 1);
    update(s.path_m, path_.length_m, k), update(s.wrap_rad, path_.wrap_rad, k);
    if (const double square = square_A2(k); !std::isnan(square)) s.current_square_A2 = square;
    s.radius_m = law_.radius_m;
    s.load_Nm = s.radius_m * s.tension_N;
    s.path_change_m = s.path_m - m_.initial_length_m;
    s.stretch_m = s.stiffness_N_per_m = s.line_speed_m_per_s = 0;  // computed in add_row
    s.pushes = pushes_;
    return s;
  }
  /// ⟨i²⟩ over the period that ends at row k. The current falls linearly as the motor accelerates:
  ///   i = i_k + (K_E N/R)(ω_k − ω),  ⟨i²⟩ = (i_k + Δ/2)² + Δ²/12,  Δ = (K_E N/R)(ω_k − ω_k−1)
  double square_A2(std::size_t k) const {
    if (k == 0 || out_.current_A.empty() || out_.speed_rad_per_s.empty()) return 0;
    const double fall_A = m_.motor.back_emf_V_s_per_rad * m_.motor.gear_ratio /
                          m_.motor.resistance_ohm *
                          (out_.speed_rad_per_s[k] - out_.speed_rad_per_s[k - 1]);
    const double mean_A = out_.current_A[k] + fall_A / 2;
    return mean_A * mean_A + fall_A * fall_A / 12;
  }

  void add_row(std::size_t k) {
    effects::ChainSample& s = sample(k);
    Sloped wound{s.radius_m * s.shaft_rad, s.radius_m}, path{s.path_m, 1}, pull;
    if (!m_.effects.empty()) {
      path = m_.effects.path(s, path);
      const bool has_mean = k < path_.mean_m.size() && !std::isnan(path_.mean_m[k]);
      const double smoothing_m = has_mean ? path.slope * (path_.mean_m[k] - s.path_m) : 0.0;
      s.stretch_m = path.value - law_.rest_m + wound.value + smoothing_m;
      s.stiffness_N_per_m =
          law_.spring.slope_N_per_m(pushes_ ? std::abs(s.stretch_m) : s.stretch_m);
      wound = m_.effects.wound(s, wound);
      s.stretch_m = path.value - law_.rest_m + wound.value + smoothing_m;
      pull = m_.effects.pull(s);
    }
    s.stretch_m = path.value - law_.rest_m + wound.value;
    s.line_speed_m_per_s = wound.slope * s.speed_rad_per_s;
    if (!out_.spring_N.empty()) set_spring_force(k, s, path, wound, pull);
    if (!out_.terminal_V.empty()) {
      const double applied_V = k >= delay_rows_ ? in_.voltage_V[k - delay_rows_] : nan;
      out_.terminal_V[k] = m_.effects.voltage_V(applied_V, s);
      out_.resistance_ohm[k] = m_.effects.resistance_ohm(m_.motor.resistance_ohm, s);
    }
    wound_slope_.push_back(wound.slope);
    aged_Nm_.push_back(m_.effects.aged_Nm(s));
  }

  /// F = f(Δx) + D dΔx/dt + effects; a tendon does not push.
  void set_spring_force(std::size_t k, const effects::ChainSample& s, Sloped path, Sloped wound,
                        Sloped pull) {
    const bool in_play = pushes_ && wound.slope == 0;  // neither end drives the other
    const double rate =
        in_play ? 0 : path.slope * path_.rate_m_per_s[k] + wound.slope * out_.speed_rad_per_s[k];
    const double taut_stretch_m = pushes_ ? std::abs(s.stretch_m) : std::max(0.0, s.stretch_m);
    const double force = std::copysign(law_.spring.force_N(taut_stretch_m), s.stretch_m) +
                         law_.damping_N_s_per_m * rate + pull.value;
    out_.spring_N[k] = pushes_ ? force : taut_fraction(s.stretch_m, rate) * std::max(0.0, force);
    out_.path_slope[k] = path.slope;
  }
  /// The fraction of the period around a sample during which a tendon is taut. Without it the
  /// damping force, and the derivatives with respect to constants, would jump between two samples.
  double taut_fraction(double stretch_m, double rate_m_per_s) const {
    const double changes_m = std::abs(rate_m_per_s) * period_s_;
    if (std::isnan(rate_m_per_s)) return nan;
    return changes_m > 0 ? std::clamp(0.5 + stretch_m / changes_m, 0.0, 1.0) : stretch_m > 0;
  }

  /// i as measured. Without a sensor, the mean around the row by the motor's law, delayed by L/R:
  ///   i = (V − K_E N ω)/R
  double current_A(std::size_t k) const {
    if (out_.current_measured) return out_.current_A[k];
    if (k + 1 >= rows_) return nan;
    const double delay_s = m_.motor.inductance_H / out_.resistance_ohm[k] + out_.driver_delay_s;
    const double next_V = out_.terminal_V[k + 1], now_V = out_.terminal_V[k];
    const double mean_V = (now_V + next_V) / 2 - delay_s * (next_V - now_V) / period_s_;
    const double delayed_speed =
        out_.speed_rad_per_s[k] - delay_s * rate_of(out_.speed_rad_per_s, k, period_s_);
    return (mean_V - m_.motor.back_emf_V_s_per_rad * m_.motor.gear_ratio * delayed_speed) /
           out_.resistance_ohm[k];
  }
  /// ī over the two periods around row k: the current that causes the change of their mean speeds
  /// (held_voltage.hpp). A current that is recorded as a mean around the row is not changed.
  double mean_current_A(std::size_t k) const {
    const double a = out_.current_averaged;
    const auto& weights = two_periods_.drives;
    double weighted = 0;
    for (std::size_t j = 0; j < weights.size(); ++j) weighted += weights[j] * current_A(k - 1 + j);
    const double voltage_weight = two_periods_.drives_per_V;  // 0 without a driver delay
    if (voltage_weight != 0 && !out_.terminal_V.empty())
      weighted += voltage_weight * out_.terminal_V[k - 1] +
                  two_periods_.drives_per_speed * rate_of(out_.shaft_rad, k, period_s_);
    return (1 - a) * weighted + a * current_A(k);
  }

  /// Sets motor_Nm, drive_Nm and uncertainty_Nm.
  void set_drive_torque() {
    const bool has_current = out_.current_measured || !out_.terminal_V.empty();
    if (!has_current || out_.tension_N.empty() || out_.shaft_rad.empty()) return;
    out_.drive_Nm.assign(rows_, nan), out_.motor_Nm.assign(rows_, nan);
    out_.uncertainty_Nm.assign(rows_, 0);
    directions_ = directions();
    for (std::size_t k = 1; k + 1 < rows_; ++k) {
      out_.motor_Nm[k] = m_.motor.gear_ratio * m_.motor.torque_Nm_per_A * mean_current_A(k);
      const double omega = out_.speed_rad_per_s[k];
      if (!(std::abs(omega) > resting_shaft_rad_per_s)) continue;
      const double before = directions_[k], after = directions_[k + 1];
      const double direction = (before + after) / 2;
      if (std::abs(direction) == 1) {
        out_.drive_Nm[k] = drive_Nm(k, direction > 0 ? 1 : -1);
        continue;
      }
      const double forwards = drive_Nm(k, 1), backwards = drive_Nm(k, -1);
      out_.drive_Nm[k] = ((1 + direction) * forwards + (1 - direction) * backwards) / 2;
      out_.uncertainty_Nm[k] =
          (2 - std::abs(before) - std::abs(after)) / 4 * std::abs(forwards - backwards);
    }
  }

  /// The mean sign s of the shaft's speed over the period that ends at each row, −1 … 1. The speed
  /// changes linearly; its change is computed from the periods before (v₋) and after (v₊):
  ///
  ///   v = Δθ/T,  Δv = √(((v₊ − v₋)/2)² + (step/T)²),  s = 2 v/Δv within ±1
  ///
  /// Δθ: travel in the period T; step: uncertainty of the encoder. If it is large, v is smoothed.
  std::vector<double> directions() const {
    const Signal& theta = out_.shaft_rad;
    constexpr double small_fraction = 0.02;  // of the rms speed; chosen
    const double uncertainty = angle_uncertainty_rad() / period_s_;
    const bool is_fine =
        uncertainty < std::max(resting_shaft_rad_per_s, small_fraction * rms(out_.speed_rad_per_s));
    const auto speed = [&](std::size_t k) {
      return is_fine ? (theta[k] - theta[k - 1]) / period_s_
                     : (out_.speed_rad_per_s[k - 1] + out_.speed_rad_per_s[k]) / 2;
    };
    const double square_uncertainty = is_fine ? uncertainty * uncertainty : 0;
    std::vector<double> signs(rows_, nan);
    for (std::size_t k = 2; k + 1 < rows_; ++k) {
      const double v = speed(k), turned = (speed(k + 1) - speed(k - 1)) / 2,
                   change = std::sqrt(turned * turned + square_uncertainty);
      signs[k] = change > 0 ? std::clamp(2 * v / change, -1.0, 1.0) : v > 0 ? 1 : -1;
    }
    return signs;
  }
  /// The specified step of the encoder, or the smallest step in the recording if that is larger.
  /// Without a specified step, the noise of the angle.
  double angle_uncertainty_rad() const {
    if (!(m_.shaft_step_rad > 0)) return noise_of(out_.shaft_rad);
    double smallest = std::numeric_limits<double>::infinity();
    for (std::size_t k = 1; k < rows_; ++k)
      if (const double turned = std::abs(out_.shaft_rad[k] - out_.shaft_rad[k - 1]);
          turned > 0.5 * m_.shaft_step_rad)
        smallest = std::min(smallest, turned);
    return std::isfinite(smallest) ? std::max(m_.shaft_step_rad, smallest) : m_.shaft_step_rad;
  }

  /// N (K_T ī − s τ_CM) − X/e for friction of one sign.
  double drive_Nm(std::size_t k, int direction) {
    const erp::MotorType& m = m_.motor;
    const double omega = out_.speed_rad_per_s[k], n = m.gear_ratio;
    effects::ChainSample& s = samples_[k];
    s.tension_N = out_.tension_N[k];
    const double motor_side_N =
        m_.effects.empty() ? s.tension_N : m_.effects.motor_side_N(s.tension_N, s);
    s.load_Nm = wound_slope_[k] * motor_side_N;
    const double friction_Nm =
        std::max(0.0, m.gear_coulomb_Nm + m_.effects.friction_Nm(direction, s) + aged_Nm_[k]);
    const double load = m.gear_viscous_Nm_s_per_rad * omega + direction * friction_Nm + s.load_Nm;
    const double e = load * direction >= 0 ? m.gear_efficiency : 1 / m.gear_efficiency;
    return out_.motor_Nm[k] - n * (direction * m.rotor_coulomb_Nm + m_.effects.rotor_Nm(s)) -
           load / e;
  }

  ChainModel m_;
  const ActuatorSignals& in_;
  const PathTrace& path_;
  const ChainTrace* other_;
  double period_s_;
  TwoPeriods two_periods_{};
  Bump bump_;
  TendonLaw law_;
  bool pushes_ = m_.actuator.tendon.path.empty();  ///< true for a drive's transmission
  std::size_t rows_ = 0, delay_rows_ = 0;
  Signal wound_slope_, aged_Nm_;
  std::vector<effects::ChainSample> samples_;
  std::vector<double> directions_;  ///< of each period
  ChainTrace out_;
};

}  // namespace

ChainTrace trace(ChainModel model, const ActuatorSignals& measured, const PathTrace& path,
                 double period_s, double speed_half_width_s, const ChainTrace* other) {
  return Tracer(std::move(model), measured, path, period_s, speed_half_width_s, other).run();
}

}  // namespace sim::residuals
