#include "sim/gap/closed_loop/learned_ecu.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>

#include "sim/control/gain_design.hpp"
#include "sim/model/actuator/ecu_units.hpp"

namespace sim::closed_loop {
namespace {

using residuals::ActuatorSignals;
using residuals::Episode;
using Phi = Eigen::Vector<double, Regressors::count>;

constexpr std::size_t max_lag = 3, least_rows = 500;  // chosen
constexpr std::size_t max_age_rows = 30;              // rows, age of a command; chosen
constexpr std::size_t max_rows = 10'000;              // of a recording; chosen
// Of `tolerated_fraction`, because the best of many ages fits by chance; chosen.
constexpr double older_factor = 0.1;
constexpr double clip_fraction = 0.98;  // of the supply; chosen

std::optional<EcuInput> input_at(const ActuatorSignals& s, std::size_t row,
                                 std::size_t command_row) {
  if (command_row >= s.reference.size() || s.shaft_rad.empty()) return {};
  const auto square_sum = [&](const residuals::Signal& signal) {
    return signal.empty() ? 0 : signal[row];
  };
  const EcuInput input{s.reference[command_row], s.shaft_rad[row], square_sum(s.current_A),
                       square_sum(s.tension_N)};
  const bool is_complete =
      !std::isnan(input.reference + input.shaft_rad + input.current_A + input.tension_N);
  return is_complete ? std::optional(input) : std::nullopt;
}

/// Regressors and voltages of one actuator in one mode.
struct Rows {
  std::vector<Phi> phi;
  std::vector<std::array<double, max_lag + 1>> volts;  ///< by lag in rows; NaN: not usable
};

bool in_mode(const ActuatorSignals& s, std::size_t row, erp::Mode mode) {
  return row < s.mode.size() && !std::isnan(s.mode[row]) &&
         std::lround(s.mode[row]) == std::lround(double(mode));
}

/// `newest`: references and modes are taken from the row after that of the sensors.
void add_rows(const Episode& e, std::size_t a, erp::Mode mode, bool newest, double radius_m,
              double supply_V, Rows& rows) {
  const ActuatorSignals& s = e.actuators[a];
  if (s.mode.empty() || s.voltage_V.empty()) return;
  std::optional<Regressors> law;
  for (std::size_t k = 0; k < e.rows; ++k) {
    const std::size_t command_row = newest ? k + 1 : k;
    const auto input = input_at(s, k, command_row);
    if (!in_mode(s, command_row, mode) || !input) {
      law.reset();
      continue;
    }
    if (!law) law.emplace(mode, radius_m);
    rows.phi.push_back(law->next(*input));
    auto& volts = rows.volts.emplace_back();
    for (std::size_t lag = 0; lag <= max_lag; ++lag) {
      const bool is_usable = k + lag < e.rows && in_mode(s, k + lag, mode) &&
                             std::abs(s.voltage_V[k + lag]) < clip_fraction * supply_V;
      volts[lag] = is_usable ? s.voltage_V[k + lag] : std::nan("");
    }
  }
}

LearnedLaw fit(const Rows& rows, std::size_t lag) {
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(Regressors::count, Regressors::count);
  Phi right = Phi::Zero(), scale = Phi::Zero();
  double sum = 0, square = 0, count = 0;
  for (std::size_t k = 0; k < rows.phi.size(); ++k) {
    const double v = rows.volts[k][lag];
    if (std::isnan(v)) continue;
    normal += rows.phi[k] * rows.phi[k].transpose(), right += rows.phi[k] * v;
    sum += v, square += v * v, ++count;
  }
  LearnedLaw law{Phi::Zero(), lag, true, 1};
  const double variance = square - sum * sum / std::max(1.0, count);
  if (count < double(least_rows) || !(variance > 0)) return law;
  scale = normal.diagonal().cwiseMax(1e-12).cwiseSqrt();
  const Phi inverse = scale.cwiseInverse();
  Eigen::MatrixXd scaled = inverse.asDiagonal() * normal * inverse.asDiagonal();
  scaled.diagonal().array() += 1e-8;  // regularization for collinear columns
  law.weights =
      inverse.asDiagonal() * Eigen::VectorXd(scaled.ldlt().solve(inverse.asDiagonal() * right));
  law.unexplained =
      std::max(0.0, square - 2 * law.weights.dot(right) + law.weights.dot(normal * law.weights)) /
      variance;
  return law;
}

}  // namespace

Phi Regressors::next(const EcuInput& input) {
  const double y = mode_ == erp::Mode::current ? input.current_A
                   : mode_ == erp::Mode::force ? input.tension_N
                                               : -radius_m_ * input.shaft_rad;
  const EcuInput& before = started_ ? last_ : input;
  Phi phi;
  phi << 1, input.reference, (input.reference - before.reference) / residuals::tick_s, y,
      started_ ? (y - last_y_) / residuals::tick_s : 0, integral_,
      (input.shaft_rad - before.shaft_rad) / residuals::tick_s, input.current_A, input.tension_N;
  integral_ += (input.reference - y) * residuals::tick_s;
  last_ = input, last_y_ = y, started_ = true;
  return phi;
}

LearnedEcu learn(std::span<const Episode> recordings, const erp::Robot& robot) {
  LearnedEcu ecu;
  for (std::size_t a = 0; a < robot.actuators.size(); ++a)
    for (const erp::Mode mode :
         {erp::Mode::voltage, erp::Mode::length, erp::Mode::current, erp::Mode::force}) {
      LearnedLaw best;
      for (const bool newest : {true, false}) {
        Rows rows;
        for (const Episode& e : recordings)
          add_rows(e, a, mode, newest, robot.actuators[a].spindle.radius_m,
                   robot.motor_of(robot.actuators[a]).supply_V, rows);
        for (std::size_t lag = 1; lag <= max_lag; ++lag)
          if (LearnedLaw law = fit(rows, lag); law.unexplained < best.unexplained)
            best = law, best.newest = newest;
      }
      if (best.unexplained < 1) ecu[{a, mode}] = best;
    }
  return ecu;
}

namespace {

ecu_channel configured(const erp::Robot& robot, const erp::Actuator& actuator) {
  ecu_channel ecu{};
  ecu_init(&ecu);
  const auto gains = design_parameters(robot, actuator, {.stuck_speed_fraction = 0});
  for (std::size_t k = 0; k < gains.size(); ++k)
    ecu_parameter(&ecu, std::uint8_t(k), gains[k], k + 1 == gains.size());
  ecu_command(&ecu, ECU_REQUEST_ARM, 0);
  return ecu;
}

struct Misfit {
  double square = 0, sum = 0, square_sum = 0, rows = 0;
};

/// Adds the misfit of the firmware with commands `age` rows old.
void add_misfit(const Episode& e, const erp::Robot& robot, std::size_t a, std::size_t age,
                Misfit& misfit) {
  const ActuatorSignals& s = e.actuators[a];
  if (s.mode.empty() || s.voltage_V.empty()) return;
  const erp::Actuator& actuator = robot.actuators[a];
  const EcuUnits units(robot.motor_of(actuator), robot.sensors_of(actuator), actuator.spindle);
  ecu_channel ecu = configured(robot, actuator);
  for (std::size_t k = age; k + 1 < std::min(e.rows, max_rows); ++k) {
    const std::size_t command_row = k + 1 - age;
    const auto input = input_at(s, k, command_row);
    if (!input || std::isnan(s.mode[command_row])) continue;
    const auto mode = static_cast<erp::Mode>(std::lround(s.mode[command_row]));
    if (mode == erp::Mode::off) ecu_command(&ecu, ECU_REQUEST_ARM, 0);
    else ecu_command(&ecu, EcuUnits::request(mode), units.setpoint(mode, input->reference));
    const ecu_inputs inputs{
        std::int32_t(std::lround(input->shaft_rad / units.shaft_rad_per_count)),
        std::int16_t(std::lround(input->current_A / units.current_A_per_count)),
        std::uint16_t(units.tension_zero_counts +
                      std::lround(input->tension_N / units.tension_N_per_count))};
    const double predicted = units.voltage_V(ecu_tick(&ecu, &inputs)), v = s.voltage_V[k + 1];
    if (std::isnan(v) || mode == erp::Mode::off) continue;
    misfit.square += (v - predicted) * (v - predicted);
    misfit.sum += v, misfit.square_sum += v * v, ++misfit.rows;
  }
}

double unexplained_at(std::span<const Episode> recordings, const erp::Robot& robot,
                      std::size_t age) {
  Misfit misfit;
  for (const Episode& e : recordings)
    for (std::size_t a = 0; a < robot.actuators.size(); ++a) add_misfit(e, robot, a, age, misfit);
  const double variance = misfit.square_sum - misfit.sum * misfit.sum / std::max(1.0, misfit.rows);
  return misfit.rows < double(least_rows) || !(variance > 0) ? 1 : misfit.square / variance;
}

}  // namespace

double unexplained_by_firmware(std::span<const Episode> recordings, const erp::Robot& robot,
                               double tolerated_fraction) {
  const double newest = unexplained_at(recordings, robot, 0);
  for (std::size_t age = 1; age <= max_age_rows && newest > tolerated_fraction; ++age)
    if (const double older = unexplained_at(recordings, robot, age);
        older < older_factor * tolerated_fraction)
      return older;
  return newest;
}

}  // namespace sim::closed_loop
