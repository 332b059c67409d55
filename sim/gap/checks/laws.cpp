#include "sim/gap/checks/laws.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "sim/gap/residuals/drives.hpp"
#include "sim/gap/residuals/indices.hpp"
#include "sim/model/actuator/spring.hpp"

namespace sim::checks {
namespace {

constexpr double together = 0.8;          // correlation, from which a slope is believed; chosen
constexpr double nothing_else = 0.98;     // the same, of what a measure that is off turns round
constexpr double widest_of_torques = 30;  // friction and efficiency count twice; chosen
constexpr double beyond_stretch = 2;      // times: of a path that is more than that; chosen
constexpr double of_a_third = 1.0 / 3;
constexpr int fewest = 30;

/// The slope of y on x, and their correlation, when a mean and what goes with `beside` are taken
/// from both.
Line line_of(const Signal& x, const Signal& y, const Signal* beside = nullptr) {
  std::vector<std::size_t> taken;
  for (std::size_t k = 0; k < std::min(x.size(), y.size()); ++k)
    if (std::isfinite(x[k]) && std::isfinite(y[k]) && !(beside && !std::isfinite((*beside)[k])))
      taken.push_back(k);
  const auto n = static_cast<Eigen::Index>(taken.size());
  if (n < fewest) return {};
  Eigen::MatrixXd known(n, beside ? 2 : 1), sides(n, 2);
  for (Eigen::Index k = 0; k < n; ++k) {
    const std::size_t row = taken[static_cast<std::size_t>(k)];
    known(k, 0) = 1;
    if (beside) known(k, 1) = (*beside)[row];
    sides(k, 0) = x[row], sides(k, 1) = y[row];
  }
  sides -= known * known.colPivHouseholderQr().solve(sides);
  const double xx = sides.col(0).squaredNorm(), yy = sides.col(1).squaredNorm();
  if (!(xx > 0 && yy > 0)) return {};
  const double xy = sides.col(0).dot(sides.col(1));
  return {xy / xx, xy / std::sqrt(xx * yy)};
}

/// Friction on the gearbox shaft.
double dry_Nm(const erp::MotorType& m) {
  return m.gear_ratio * m.rotor_coulomb_Nm + m.gear_coulomb_Nm;
}

/// Of what is not constant in it.
double rms(const Signal& signal) {
  double n = 0, sum = 0, square = 0;
  for (const double x : signal)
    if (std::isfinite(x)) ++n, sum += x, square += x * x;
  return n > 0 ? std::sqrt(std::fmax(0, square / n - sum / n * sum / n)) : 0;
}

/// The stiffness between the two ends is known, and both were measured.
bool stretches(const erp::Robot& robot, const erp::Actuator& actuator) {
  const erp::Drive* drive = residuals::drive_of(robot, actuator.name);
  return !drive || (drive->find<erp::LoadEncoder>() && drive->stiffness_Nm_per_rad);
}

/// Its tension is no column, but the nothing that hangs on a gearbox shaft that has all the load.
bool pulls_nothing(const erp::Robot& robot, const erp::Actuator& actuator) {
  const erp::Drive* drive = residuals::drive_of(robot, actuator.name);
  return drive && !has_two_ends(*drive);
}

}  // namespace

bool Law::is_consistent() const { return std::abs(line.correlation) > together; }

bool Law::is_inconclusive() const { return line.correlation != 0 && !good() && !suspicious(); }

bool Law::near() const { return line.slope < widest && line.slope > 1 / widest; }

bool Law::suspicious() const {
  return std::abs(line.correlation) > (small_difference ? nothing_else : together) && !near();
}

Means Laws::means(const Episode& episode, std::size_t from, std::size_t until) {
  Means means = means_of(episode, from, until);
  find_paths(means);
  return means;
}

void Laws::find_paths(Means& means) {
  means.paths = bones_.paths(means.joints, means.rows, each(means.actuators.size()));
}

std::vector<Column> Laws::crossed_by(std::size_t actuator) const {
  std::vector<Column> joints;
  for (const std::size_t j : bones_.crossed_by(actuator)) joints.push_back({Quantity::angle, j});
  return joints;
}

std::vector<Law> Laws::held_against(const Means& means, std::size_t actuator) const {
  std::vector<Law> laws;
  motor(actuator, means, laws), torque(actuator, means, laws), tendon(actuator, means, laws);
  return laws;
}

void Laws::motor(std::size_t a, const Means& means, std::vector<Law>& laws) const {
  const erp::MotorType& m = robot_.motor_of(robot_.actuators[a]);
  const Signal &voltage = means[{Quantity::voltage, a}], &current = means[{Quantity::current, a}];
  const Signal& speed = means.actuators[a].speed_rad_per_s;
  if (voltage.empty() || speed.empty()) return;
  const double back_emf = m.back_emf_V_s_per_rad * m.gear_ratio;
  Signal foretold(means.rows), drop(means.rows);
  for (std::size_t k = 0; k < means.rows; ++k)
    foretold[k] = voltage[k] / back_emf,
    drop[k] = (voltage[k] - back_emf * speed[k]) / m.resistance_ohm;
  std::vector<Column> columns{{Quantity::voltage, a}, {Quantity::shaft, a}};
  laws.push_back({Law::Kind::speed, columns, foretold, speed, line_of(foretold, speed)});
  if (current.empty()) return;
  columns.push_back({Quantity::current, a});
  laws.push_back({Law::Kind::current, columns, drop, current, line_of(drop, current)});
}

void Laws::torque(std::size_t a, const Means& means, std::vector<Law>& laws) const {
  const erp::MotorType& m = robot_.motor_of(robot_.actuators[a]);
  const double inertia = m.rotor_inertia_kg_m2 * m.gear_ratio * m.gear_ratio + m.gear_inertia_kg_m2;
  const Signal &current = means[{Quantity::current, a}], &tension = means[{Quantity::tension, a}];
  const auto& shaft = means.actuators[a];
  if (current.empty() || tension.empty() || shaft.acceleration_rad_per_s2.empty()) return;
  Signal foretold(means.rows), torque(means.rows), way(means.rows);
  for (std::size_t k = 0; k < means.rows; ++k) {
    foretold[k] = robot_.actuators[a].spindle.radius_m * tension[k] +
                  inertia * shaft.acceleration_rad_per_s2[k];
    torque[k] = m.gear_ratio * m.torque_Nm_per_A * current[k];
    way[k] = (shaft.speed_rad_per_s[k] > 0) - (shaft.speed_rad_per_s[k] < 0);
  }
  std::vector<Column> columns{{Quantity::shaft, a}, {Quantity::tension, a}, {Quantity::current, a}};
  if (!(rms(foretold) > dry_Nm(m))) return;  // within that anything may hold
  if (pulls_nothing(robot_, robot_.actuators[a])) columns.erase(columns.begin() + 1);
  laws.push_back({Law::Kind::torque, columns, foretold, torque, line_of(foretold, torque, &way),
                  widest_of_torques});
}

double Laws::swing_of_pull_N(std::size_t a, const Means& means) const {
  const erp::Actuator& actuator = robot_.actuators[a];
  const erp::MotorType& m = robot_.motor_of(actuator);
  const Signal& current = means[{Quantity::current, a}];
  if (current.empty()) return robot_.sensors_of(actuator).tension_range_N / 2;
  return (m.gear_ratio * m.torque_Nm_per_A * rms(current) + dry_Nm(m)) / actuator.spindle.radius_m;
}

void Laws::tendon(std::size_t a, const Means& means, std::vector<Law>& laws) const {
  const Signal &shaft = means[{Quantity::shaft, a}], &tension = means[{Quantity::tension, a}];
  const Signal& path = means.paths[a].length_m;
  if (shaft.empty() || path.empty()) return;
  const erp::Actuator& actuator = robot_.actuators[a];
  const bool weighed = !tension.empty() && stretches(robot_, actuator);
  const Spring spring = Spring::of(actuator.tendon);
  const double pretension_m = spring.stretch_m(actuator.tendon.pretension_N);
  const double stiffness = spring.slope_N_per_m(pretension_m);
  Signal line(means.rows), pull(means.rows);
  for (std::size_t k = 0; k < means.rows; ++k) {
    line[k] = -actuator.spindle.radius_m * shaft[k];
    pull[k] = stiffness * (path[k] - line[k]);
    if (weighed) line[k] += tension[k] / stiffness;
  }
  std::vector<Column> columns = crossed_by(a);
  columns.push_back({Quantity::shaft, a});
  if (weighed) columns.push_back({Quantity::tension, a});
  const double wound_m = of_a_third * actuator.spindle.radius_m * rms(shaft);
  const Law path_law{.kind = Law::Kind::path,
                     .columns = columns,
                     .foretold = path,
                     .measured = line,
                     .line = line_of(path, line),
                     .small_difference = rms(path) < wound_m};
  const double pull_N = weighed ? 0 : swing_of_pull_N(a, means);
  if (rms(path) > beyond_stretch * pull_N / stiffness) laws.push_back(path_law);
  if (weighed)
    laws.push_back({.kind = Law::Kind::spring,
                    .columns = columns,
                    .foretold = pull,
                    .measured = tension,
                    .line = line_of(pull, tension),
                    .small_difference = rms(tension) < stiffness * wound_m});
}

}  // namespace sim::checks
