#include "sim/gap/estimation/row_timing.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <optional>

#include "interfaces/recording/table.hpp"

namespace sim::estimation {
namespace {

using residuals::ActuatorSignals;
using residuals::Signal;

constexpr std::size_t max_lag = 20;           // chosen
constexpr std::size_t fewest_samples = 500;   // chosen
constexpr double largest_variance = 1.0 / 3;  // of the residual, relative to no lag; chosen

/// The normal equations of V on i, ω, di/dt and 1 for one lag.
struct Regression {
  Eigen::Matrix4d xx = Eigen::Matrix4d::Zero();
  Eigen::Vector4d xy = Eigen::Vector4d::Zero();
  double yy = 0, count = 0;

  void add(const Eigen::Vector4d& x, double y) {
    xx += x * x.transpose(), xy += x * y, yy += y * y, ++count;
  }
  double variance() const {
    return count > 0 ? std::max(0.0, yy - xy.dot(xx.ldlt().solve(xy))) / count : 0;
  }
};

bool has_motor_signals(const ActuatorSignals& s) {
  return !s.voltage_V.empty() && !s.current_A.empty() && !s.shaft_rad.empty() && !s.current_around;
}

void add(const ActuatorSignals& s, double period_s, std::vector<Regression>& lags) {
  const std::size_t rows = s.shaft_rad.size();
  for (std::size_t k = max_lag; k + 1 < rows; ++k) {
    const double rate = (s.current_A[k] - s.current_A[k - 1]) / period_s;
    const Eigen::Vector4d x(s.current_A[k], residuals::rate_of(s.shaft_rad, k, period_s), rate, 1);
    bool valid = x.allFinite();
    for (std::size_t lag = 0; lag <= max_lag && valid; ++lag)
      valid = std::isfinite(s.voltage_V[k - lag]);
    for (std::size_t lag = 0; lag <= max_lag && valid; ++lag)
      lags[lag].add(x, s.voltage_V[k - lag]);
  }
}

/// The lag of one actuator in all recordings; empty: not enough samples.
std::optional<std::size_t> lag_of(std::span<const residuals::Episode> episodes, std::size_t a) {
  std::vector<Regression> lags(max_lag + 1);
  for (const residuals::Episode& e : episodes)
    if (has_motor_signals(e.actuators[a])) add(e.actuators[a], e.period_s, lags);
  if (lags[0].count < fewest_samples) return std::nullopt;
  std::size_t best = 0;
  for (std::size_t lag = 1; lag <= max_lag; ++lag)
    if (lags[lag].variance() < lags[best].variance()) best = lag;
  return lags[best].variance() < largest_variance * lags[0].variance() ? best : 0;
}

Signal shifted(const Signal& signal, std::size_t rows) {
  Signal shifted_signal(signal.size(), recording::not_taken);
  for (std::size_t k = rows; k < signal.size(); ++k) shifted_signal[k] = signal[k - rows];
  return shifted_signal;
}

}  // namespace

RowTiming row_timing(std::span<const residuals::Episode> episodes) {
  RowTiming timing{0, episodes.empty() ? 0 : episodes[0].period_s};
  std::optional<std::size_t> common;
  std::size_t actuators = 0;
  for (std::size_t a = 0; !episodes.empty() && a < episodes[0].actuators.size(); ++a) {
    const auto lag = lag_of(episodes, a);
    if (!lag) continue;
    if (common && *common != *lag) return timing;
    common = lag, ++actuators;
  }
  if (common && (actuators > 1 || episodes[0].actuators.size() == 1)) timing.rows = *common;
  return timing;
}

void compensate(const RowTiming& timing, std::vector<residuals::Episode>& episodes,
                std::vector<std::string>& remarks) {
  if (timing.rows == 0) return;
  for (residuals::Episode& e : episodes) {
    for (ActuatorSignals& s : e.actuators) {
      s.voltage_V = shifted(s.voltage_V, timing.rows);
      if (timing.from_row()) s.mode = shifted(s.mode, 1), s.reference = shifted(s.reference, 1);
    }
    if (timing.is_delayed()) e.voltage_delay_s = timing.delay_s();
  }
  remarks.push_back(
      timing.from_row()
          ? "voltage, mode and reference hold from their row to the next, as the motors' law "
            "shows; they are shifted by one row"
          : fmt::format(
                "voltages act {:.3g} ms after their row, or all sensors lag by this time, as the "
                "motors' law shows; the delay is compensated",
                1e3 * timing.delay_s()));
}

}  // namespace sim::estimation
