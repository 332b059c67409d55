#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <ostream>

#include "interfaces/recording/table.hpp"
#include "launch/erp/record/log.hpp"
#include "launch/erp/verbs/guarded.hpp"

namespace launch {
namespace {

using recording::Column;

struct Effort {
  std::string actuator;
  double min_N = 0, mean_N = 0, max_N = 0;
  double ripple_N = 0;  ///< oscillation: RMS of the tension about a line fitted over `line_span_s`
  double energy_J = 0;  ///< ∫ V i dt: net energy from the supply
};

constexpr double line_span_s = 0.1;  // chosen

/// Sums over a moving window, for fitting a line: n, Σt, Σt², Σy, Σty.
struct Window {
  double n = 0, t = 0, tt = 0, y = 0, ty = 0;
  void add(double time_s, double value, double sign) {
    n += sign, t += sign * time_s, tt += sign * time_s * time_s;
    y += sign * value, ty += sign * time_s * value;
  }
  double line_at(double time_s) const {
    const double determinant = n * tt - t * t;
    constexpr double rounding = 1e-9;  // relative; below it, all times are equal
    const double slope = determinant > rounding * n * tt ? (n * ty - t * y) / determinant : 0;
    return (y + slope * (n * time_s - t)) / n;
  }
};

/// RMS deviation of each value from the line fitted to the values within ± `line_span_s` / 2 around
/// it.
double ripple(const std::vector<double>& time_s, const std::vector<double>& values) {
  double squares = 0;
  Window window;
  std::size_t first = 0, last = 0;  // the window is first … last − 1
  const auto add = [&](std::size_t k, double sign) {
    window.add(time_s[k] - time_s.front(), values[k], sign);
  };
  for (std::size_t k = 0; k < values.size(); ++k) {
    while (last < values.size() && time_s[last] <= time_s[k] + line_span_s / 2) add(last++, 1);
    while (time_s[first] < time_s[k] - line_span_s / 2) add(first++, -1);
    const double deviation = values[k] - window.line_at(time_s[k] - time_s.front());
    squares += deviation * deviation;
  }
  return values.empty() ? 0 : std::sqrt(squares / static_cast<double>(values.size()));
}

Effort effort_of(const recording::Table& table, const std::string& actuator, double from_s) {
  const Column& time = table.columns.front();
  const Column& tension = *table.find(actuator + ".tension_N");
  const Column* voltage = table.find(actuator + ".voltage_V");
  const Column* current = table.find(actuator + ".current_A");
  Effort e{actuator, 1e300, 0, 0};
  std::vector<double> time_s, tension_N;
  for (std::size_t k = 0; k < time.values.size(); ++k) {
    if (time.values[k] < from_s) continue;
    if (const double f = tension.values[k]; !std::isnan(f)) {
      time_s.push_back(time.values[k]), tension_N.push_back(f);
      e.min_N = std::min(e.min_N, f), e.max_N = std::max(e.max_N, f);
      e.mean_N += f;
    }
    if (!voltage || !current || k + 1 == time.values.size()) continue;
    const double power_W = voltage->values[k] * current->values[k];
    if (!std::isnan(power_W)) e.energy_J += power_W * (time.values[k + 1] - time.values[k]);
  }
  if (!tension_N.empty()) e.mean_N /= static_cast<double>(tension_N.size());
  e.ripple_N = ripple(time_s, tension_N);
  return e;
}

/// The effort of each actuator with a tension. Ignores rows before `from_s` and empty cells.
std::vector<Effort> efforts(const recording::Table& table, double from_s) {
  std::vector<Effort> all;
  for (const std::string& actuator : table.owners("tension_N"))
    all.push_back(effort_of(table, actuator, from_s));
  return all;
}

}  // namespace

int log_effort(const std::string& path, double from_s, std::ostream& out) {
  return guarded([&] {
    out << fmt::format("{:<24} {:>10} {:>10} {:>10} {:>10} {:>12}\n", "actuator", "min N", "mean N",
                       "max N", "ripple N", "energy J");
    double energy_J = 0;
    for (const Effort& e : efforts(recording::read_table(path), from_s)) {
      out << fmt::format("{:<24} {:>10.2f} {:>10.2f} {:>10.2f} {:>10.3f} {:>12.3f}\n", e.actuator,
                         e.min_N, e.mean_N, e.max_N, e.ripple_N, e.energy_J);
      energy_J += e.energy_J;
    }
    out << fmt::format("{:<24} {:>56.3f}\n", "total", energy_J);
    return flush_or_throw(out);
  });
}

}  // namespace launch
