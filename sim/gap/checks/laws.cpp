#include "sim/gap/checks/laws.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "sim/gap/residuals/drives.hpp"
#include "sim/gap/residuals/indices.hpp"
#include "sim/model/actuator/spring.hpp"

namespace sim::checks {
namespace {

constexpr double correlated = 0.8;           // smallest correlation of a meaningful slope; chosen
constexpr double fully_correlated = 0.98;    // the same for a small difference; chosen
constexpr double largest_torque_slope = 30;  // friction and efficiency act twice; chosen
constexpr double beyond_stretch = 2;         // smallest path variation / possible stretch; chosen
constexpr double largest_error = 1.0 / 3;    // relative, of a dimension of the tendon; chosen
constexpr int fewest_samples = 30;           // of a fitted line; chosen

/// Slope of y over x and their correlation, after a regression of both on a constant and on
/// `regressor`.
Line fit_line(const Signal& x, const Signal& y, const Signal* regressor = nullptr) {
  std::vector<std::size_t> valid;
  for (std::size_t k = 0; k < std::min(x.size(), y.size()); ++k)
    if (std::isfinite(x[k]) && std::isfinite(y[k]) &&
        !(regressor && !std::isfinite((*regressor)[k])))
      valid.push_back(k);
  const auto n = static_cast<Eigen::Index>(valid.size());
  if (n < fewest_samples) return {};
  Eigen::MatrixXd regressors(n, regressor ? 2 : 1), sides(n, 2);
  for (Eigen::Index k = 0; k < n; ++k) {
    const std::size_t row = valid[static_cast<std::size_t>(k)];
    regressors(k, 0) = 1;
    if (regressor) regressors(k, 1) = (*regressor)[row];
    sides(k, 0) = x[row], sides(k, 1) = y[row];
  }
  sides -= regressors * regressors.colPivHouseholderQr().solve(sides);
  const double xx = sides.col(0).squaredNorm(), yy = sides.col(1).squaredNorm();
  if (!(xx > 0 && yy > 0)) return {};
  const double xy = sides.col(0).dot(sides.col(1));
  return {xy / xx, xy / std::sqrt(xx * yy)};
}

/// Coulomb friction torque at the gearbox shaft.
double coulomb_Nm(const erp::MotorType& m) {
  return m.gear_ratio * m.rotor_coulomb_Nm + m.gear_coulomb_Nm;
}

double standard_deviation(const Signal& signal) {
  double n = 0, sum = 0, square = 0;
  for (const double x : signal)
    if (std::isfinite(x)) ++n, sum += x, square += x * x;
  return n > 0 ? std::sqrt(std::fmax(0, square / n - sum / n * sum / n)) : 0;
}

/// Whether the stiffness of the tendon or drive is known and both of its ends are measured.
bool has_measured_stretch(const erp::Robot& robot, const erp::Actuator& actuator) {
  const erp::Drive* drive = residuals::drive_of(robot, actuator.name);
  return !drive || (drive->find<erp::LoadEncoder>() && drive->stiffness_Nm_per_rad);
}

/// Whether the recording has no tension column. The whole load of such a drive acts at its gearbox
/// shaft, and its tension is 0.
bool has_no_tension(const erp::Robot& robot, const erp::Actuator& actuator) {
  const erp::Drive* drive = residuals::drive_of(robot, actuator.name);
  return drive && !has_load_sensor(*drive);
}

}  // namespace

bool Law::is_consistent() const { return std::abs(line.correlation) > correlated; }

bool Law::is_inconclusive() const {
  return line.correlation != 0 && !is_satisfied() && !is_suspicious();
}

bool Law::has_plausible_slope() const {
  return line.slope < largest_slope && line.slope > 1 / largest_slope;
}

bool Law::is_suspicious() const {
  return std::abs(line.correlation) > (small_difference ? fully_correlated : correlated) &&
         !has_plausible_slope();
}

Means Laws::means(const Episode& episode, std::size_t first, std::size_t end) {
  Means means = means_of(episode, first, end);
  compute_paths(means);
  return means;
}

void Laws::compute_paths(Means& means) {
  means.paths = bones_.paths(means.joints, means.rows, each(means.actuators.size()));
}

std::vector<Column> Laws::crossed_by(std::size_t actuator) const {
  std::vector<Column> joints;
  for (const std::size_t j : bones_.crossed_by(actuator)) joints.push_back({Quantity::angle, j});
  return joints;
}

std::vector<Law> Laws::evaluate(const Means& means, std::size_t actuator) const {
  std::vector<Law> laws;
  add_motor_laws(actuator, means, laws);
  add_torque_law(actuator, means, laws);
  add_tendon_laws(actuator, means, laws);
  return laws;
}

void Laws::add_motor_laws(std::size_t a, const Means& means, std::vector<Law>& laws) const {
  const erp::MotorType& m = robot_.motor_of(robot_.actuators[a]);
  const Signal &voltage = means[{Quantity::voltage, a}], &current = means[{Quantity::current, a}];
  const Signal& speed = means.actuators[a].speed_rad_per_s;
  if (voltage.empty() || speed.empty()) return;
  const double back_emf = m.back_emf_V_s_per_rad * m.gear_ratio;
  Signal predicted(means.rows), drop(means.rows);
  for (std::size_t k = 0; k < means.rows; ++k)
    predicted[k] = voltage[k] / back_emf,
    drop[k] = (voltage[k] - back_emf * speed[k]) / m.resistance_ohm;
  std::vector<Column> columns{{Quantity::voltage, a}, {Quantity::shaft, a}};
  laws.push_back({Law::Kind::speed, columns, predicted, speed, fit_line(predicted, speed)});
  if (current.empty()) return;
  columns.push_back({Quantity::current, a});
  laws.push_back({Law::Kind::current, columns, drop, current, fit_line(drop, current)});
}

void Laws::add_torque_law(std::size_t a, const Means& means, std::vector<Law>& laws) const {
  const erp::MotorType& m = robot_.motor_of(robot_.actuators[a]);
  const double inertia = m.rotor_inertia_kg_m2 * m.gear_ratio * m.gear_ratio + m.gear_inertia_kg_m2;
  const Signal &current = means[{Quantity::current, a}], &tension = means[{Quantity::tension, a}];
  const auto& shaft = means.actuators[a];
  if (current.empty() || tension.empty() || shaft.acceleration_rad_per_s2.empty()) return;
  Signal predicted(means.rows), torque(means.rows), direction(means.rows);
  for (std::size_t k = 0; k < means.rows; ++k) {
    predicted[k] = robot_.actuators[a].spindle.radius_m * tension[k] +
                   inertia * shaft.acceleration_rad_per_s2[k];
    torque[k] = m.gear_ratio * m.torque_Nm_per_A * current[k];
    direction[k] = (shaft.speed_rad_per_s[k] > 0) - (shaft.speed_rad_per_s[k] < 0);
  }
  std::vector<Column> columns{{Quantity::shaft, a}, {Quantity::tension, a}, {Quantity::current, a}};
  if (!(standard_deviation(predicted) > coulomb_Nm(m)))
    return;  // Coulomb friction alone could balance the load
  if (has_no_tension(robot_, robot_.actuators[a])) columns.erase(columns.begin() + 1);
  laws.push_back({Law::Kind::torque, columns, predicted, torque,
                  fit_line(predicted, torque, &direction), largest_torque_slope});
}

double Laws::tension_variation_N(std::size_t a, const Means& means) const {
  const erp::Actuator& actuator = robot_.actuators[a];
  const erp::MotorType& m = robot_.motor_of(actuator);
  const Signal& current = means[{Quantity::current, a}];
  if (current.empty()) return robot_.sensors_of(actuator).tension_range_N / 2;
  return (m.gear_ratio * m.torque_Nm_per_A * standard_deviation(current) + coulomb_Nm(m)) /
         actuator.spindle.radius_m;
}

void Laws::add_tendon_laws(std::size_t a, const Means& means, std::vector<Law>& laws) const {
  const Signal &shaft = means[{Quantity::shaft, a}], &tension = means[{Quantity::tension, a}];
  const Signal& path = means.paths[a].length_m;
  if (shaft.empty() || path.empty()) return;
  const erp::Actuator& actuator = robot_.actuators[a];
  const bool has_tension = !tension.empty() && has_measured_stretch(robot_, actuator);
  const Spring spring = Spring::of(actuator.tendon);
  const double pretension_m = spring.stretch_m(actuator.tendon.pretension_N);
  const double stiffness = spring.slope_N_per_m(pretension_m);
  Signal line(means.rows), spring_N(means.rows);
  for (std::size_t k = 0; k < means.rows; ++k) {
    line[k] = -actuator.spindle.radius_m * shaft[k];
    spring_N[k] = stiffness * (path[k] - line[k]);
    if (has_tension) line[k] += tension[k] / stiffness;
  }
  std::vector<Column> columns = crossed_by(a);
  columns.push_back({Quantity::shaft, a});
  if (has_tension) columns.push_back({Quantity::tension, a});
  const double smallest_change_m =
      largest_error * actuator.spindle.radius_m * standard_deviation(shaft);
  const Law path_law{.kind = Law::Kind::path,
                     .columns = columns,
                     .predicted = path,
                     .measured = line,
                     .line = fit_line(path, line),
                     .small_difference = standard_deviation(path) < smallest_change_m};
  const double variation_N = has_tension ? 0 : tension_variation_N(a, means);
  if (standard_deviation(path) > beyond_stretch * variation_N / stiffness) laws.push_back(path_law);
  if (has_tension)
    laws.push_back(
        {.kind = Law::Kind::spring,
         .columns = columns,
         .predicted = spring_N,
         .measured = tension,
         .line = fit_line(spring_N, tension),
         .small_difference = standard_deviation(tension) < stiffness * smallest_change_m});
}

}  // namespace sim::checks
