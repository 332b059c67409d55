#include "sim/gap/checks/dead_columns.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "sim/gap/residuals/drives.hpp"

namespace sim::checks {
namespace {

// Thresholds; chosen.
constexpr double shortest_s = 2;         // of a dead period
constexpr double supply_fraction = 0.1;  // of the supply voltage
constexpr double range_fraction = 0.1;   // of the tension sensor
constexpr double noise_factor = 20;      // times step and noise of the sensor
// The same for a column that is constant in the whole recording.
constexpr double noise_factor_whole = 5;
constexpr double travel_m = 0.005, travel_without_tension_m = 0.015;  // of a tendon

struct Run {
  std::size_t first = 0, end = 0;
  std::size_t rows() const { return end - first; }
};

/// The longest run of one constant value. Missing samples (NaN) do not interrupt it.
Run longest_run(const Signal& signal) {
  Run longest, run;
  double value = recording::not_taken;
  for (std::size_t k = 0; k < signal.size(); ++k) {
    if (std::isnan(signal[k])) continue;
    if (signal[k] != value) value = signal[k], run.first = k;
    run.end = k + 1;
    if (run.rows() > longest.rows()) longest = run;
  }
  return longest;
}

/// Difference of the 95 % and 5 % quantiles; 0 for fewer than 20 samples.
double spread_of(Signal signal) {
  std::erase_if(signal, [](double x) { return !std::isfinite(x); });
  if (signal.size() < 20) return 0;
  std::ranges::sort(signal);
  return signal[signal.size() * 19 / 20] - signal[signal.size() / 20];
}

const Signal& signal_of(const Episode& e, const Column& c) {
  if (c.quantity == Quantity::angle) return e.joints[c.of].angle_rad;
  const residuals::ActuatorSignals& s = e.actuators[c.of];
  const std::array all{&s.voltage_V, &s.current_A, &s.shaft_rad, &s.tension_N};
  return *all[static_cast<std::size_t>(c.quantity)];
}

/// Finds the columns that imply, by the laws of these rows, that a constant column should change.
/// No such column: it may be constant.
class ExpectedChange {
 public:
  ExpectedChange(const erp::Robot& robot, const Laws& laws, const Means& means,
                 bool whole_recording)
      : robot_(robot), laws_(laws), means_(means), whole_recording_(whole_recording) {}

  std::vector<Column> of(const Column& c) const {
    const bool of_motor = c.quantity == Quantity::voltage || c.quantity == Quantity::current;
    if (of_motor && residuals::drive_of(robot_, actuator(c.of).name)) return of_control(c.of);
    switch (c.quantity) {
      case Quantity::voltage:
        return of_voltage(c.of);
      case Quantity::current:
        return of_current(c.of);
      case Quantity::shaft:
        return of_shaft(c.of);
      case Quantity::tension:
        return of_tension(c.of);
      case Quantity::angle:
        break;
    }
    return of_angle(c.of);
  }

 private:
  const Signal& measured(Quantity quantity, std::size_t a) const { return means_[{quantity, a}]; }
  const erp::Actuator& actuator(std::size_t a) const { return robot_.actuators[a]; }
  const erp::MotorType& motor(std::size_t a) const { return robot_.motor_of(actuator(a)); }

  /// factor · signal + speed_factor · K_E N ω, in V: R i + K_E N ω or V − K_E N ω.
  Signal volts(std::size_t a, const Signal& signal, double factor, double speed_factor) const {
    Signal sum = signal;
    const Signal& speed = means_.actuators[a].speed_rad_per_s;
    const double back_emf = motor(a).back_emf_V_s_per_rad * motor(a).gear_ratio;
    for (std::size_t k = 0; k < sum.size(); ++k)
      sum[k] = factor * sum[k] + speed_factor * back_emf * (speed.empty() ? 0 : speed[k]);
    return sum;
  }
  /// The model of a drive has neither spring nor weight. Only the voltage or current can reverse
  /// its motion.
  std::vector<Column> of_control(std::size_t a) const {
    constexpr double fast_fraction = 0.2;  // of the largest speed; chosen
    const Signal& speed = means_.actuators[a].speed_rad_per_s;
    double max_speed = 0, previous = 0;
    for (const double w : speed)
      if (std::isfinite(w)) max_speed = std::fmax(max_speed, std::abs(w));
    int reversals = 0;
    for (const double w : speed)
      if (std::abs(w) > fast_fraction * max_speed) reversals += previous * w < 0, previous = w;
    if (!whole_recording_ || reversals < 2) return {};
    return {{Quantity::shaft, a}};
  }
  std::vector<Column> of_voltage(std::size_t a) const {
    const Signal& current = measured(Quantity::current, a);
    const double implied_V = spread_of(volts(a, current, motor(a).resistance_ohm, 1));
    if (spread_of(current) == 0 || !(implied_V > supply_fraction * motor(a).supply_V)) return {};
    return {{Quantity::current, a}, {Quantity::shaft, a}};
  }
  std::vector<Column> of_current(std::size_t a) const {
    const Signal& voltage = measured(Quantity::voltage, a);
    const erp::SensorType& sensors = robot_.sensors_of(actuator(a));
    const double step_A = 2 * sensors.current_range_A / std::exp2(sensors.current_bits);
    const double drop_A = spread_of(volts(a, voltage, 1, -1)) / motor(a).resistance_ohm;
    const double threshold = whole_recording_ ? noise_factor_whole : noise_factor;
    if (spread_of(voltage) == 0 || !(drop_A > threshold * (step_A + sensors.current_noise_A)))
      return {};
    return {{Quantity::voltage, a}, {Quantity::shaft, a}};
  }
  /// If the shaft is at rest, the tendon is a spring between two measured ends, and the spring law
  /// holds.
  std::vector<Column> of_shaft(std::size_t a) const {
    if (!spring_holds(a) && spread_of(means_.paths[a].length_m) > travel_m)
      return laws_.crossed_by(a);
    // The encoder of a drive that is not dead is never constant for so long.
    const bool is_drive = actuator(a).tendon.path.empty();
    for (const Quantity control : {Quantity::voltage, Quantity::current})
      if (is_drive && spread_of(measured(control, a)) > 0) return {{control, a}};
    return {};
  }
  /// The tension of a slack tendon may be constant: then neither the spring law nor the motor
  /// current implies a change.
  std::vector<Column> of_tension(std::size_t a) const {
    const erp::SensorType& sensors = robot_.sensors_of(actuator(a));
    const double slack_N = range_fraction * sensors.tension_range_N,
                 step_N = sensors.tension_range_N / std::exp2(sensors.tension_bits);
    const Signal& tension = measured(Quantity::tension, a);
    const bool may_be_slack = tension.empty() || !(tension[0] > slack_N);
    const double threshold_N =
        may_be_slack ? slack_N : noise_factor * (step_N + sensors.tension_noise_N);
    std::vector<Column> evidence;
    for (const Law& law : laws_.evaluate(means_, a))
      if (law.kind == Law::Kind::spring && spread_of(law.predicted) > threshold_N)
        evidence.assign(law.columns.begin(), law.columns.end() - 1);
    const Signal& current = measured(Quantity::current, a);
    const double pull_N_per_A =
        motor(a).gear_ratio * motor(a).torque_Nm_per_A / actuator(a).spindle.radius_m;
    if (!current.empty() && !(pull_N_per_A * spread_of(current) > threshold_N)) return {};
    return evidence;
  }
  /// If antagonistic tendons hold a joint still, their spring laws hold.
  std::vector<Column> of_angle(std::size_t j) const {
    std::vector<Column> evidence;
    for (std::size_t a = 0; a < means_.actuators.size(); ++a) {
      if (!std::ranges::count(laws_.crossed_by(a), Column{Quantity::angle, j})) continue;
      const bool has_tension = !measured(Quantity::tension, a).empty();
      if (has_tension && spring_holds(a)) return {};
      const double travel = actuator(a).spindle.radius_m * spread_of(measured(Quantity::shaft, a));
      if (travel > (has_tension ? travel_m : travel_without_tension_m))
        evidence.push_back({Quantity::shaft, a});
    }
    return evidence;
  }
  bool spring_holds(std::size_t a) const {
    for (const Law& law : laws_.evaluate(means_, a))
      if (law.kind == Law::Kind::spring) return law.is_satisfied();
    return false;
  }

  const erp::Robot& robot_;
  const Laws& laws_;
  const Means& means_;
  const bool whole_recording_;
};

}  // namespace

bool nothing_changes(const Episode& episode) {
  return std::ranges::all_of(
      residuals::all_columns(episode.actuators.size(), episode.joints.size()),
      [&](const Column& column) {
        double measured = recording::not_taken;
        for (const double x : signal_of(episode, column)) {
          if (std::isnan(measured)) measured = x;
          if (!std::isnan(x) && x != measured) return false;
        }
        return true;
      });
}

std::vector<DeadColumn> dead_columns(const Episode& episode, const erp::Robot& robot, Laws& laws) {
  std::vector<DeadColumn> dead;
  std::optional<Means> recording_means;
  for (const Column& column :
       residuals::all_columns(episode.actuators.size(), episode.joints.size())) {
    const Signal& signal = signal_of(episode, column);
    const Run run = longest_run(signal);
    const auto valid = std::ranges::count_if(signal, [](double x) { return !std::isnan(x); });
    const bool whole_recording =
        run.rows() > 0 && valid > 0 && std::ranges::all_of(signal, [&](double x) {
          return std::isnan(x) || x == signal[run.first];
        });
    if (!whole_recording && double(run.rows()) * episode.period_s < shortest_s) continue;
    if (whole_recording && !recording_means) recording_means = laws.means(episode, 0, episode.rows);
    const Means run_means = whole_recording ? Means{} : laws.means(episode, run.first, run.end);
    const auto evidence =
        ExpectedChange(robot, laws, whole_recording ? *recording_means : run_means, whole_recording)
            .of(column);
    if (!evidence.empty())
      dead.push_back({column, signal[run.first], run.first, run.end, whole_recording, evidence});
  }
  return dead;
}

}  // namespace sim::checks
