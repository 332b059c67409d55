#include "sim/gap/estimation/defective_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "interfaces/recording/table.hpp"

namespace sim::estimation {
namespace {

using residuals::Episode;
using residuals::Signal;

std::vector<Signal*> sensors_of(Episode& e) {
  std::vector<Signal*> all;
  for (auto& s : e.actuators)
    for (Signal* signal : {&s.current_A, &s.shaft_rad, &s.tension_N})
      if (!signal->empty()) all.push_back(signal);
  for (auto& j : e.joints)
    if (!j.angle_rad.empty()) all.push_back(&j.angle_rad);
  return all;
}

/// The signals that change little from row to row: angles and tensions.
std::vector<Signal*> positions_of(Episode& e) {
  std::vector<Signal*> all = sensors_of(e);
  for (auto& s : e.actuators) std::erase(all, &s.current_A);
  return all;
}

/// Whether each row repeats the sensors of the row before.
std::vector<bool> repeats(Episode& e) {
  const auto sensors = sensors_of(e);
  std::vector<bool> same(e.rows, sensors.size() > 1);
  if (e.rows > 0) same[0] = false;
  for (std::size_t k = 1; k < e.rows && sensors.size() > 1; ++k)
    for (const Signal* s : sensors)
      if (!((*s)[k] == (*s)[k - 1])) {
        same[k] = false;
        break;
      }
  return same;
}

/// The smallest change of a signal between two rows; 0: constant.
double step_of(const Signal& signal) {
  constexpr double rounding_error = 1e-12;
  double smallest = 0;
  for (std::size_t k = 1; k < signal.size(); ++k)
    if (const double d = std::abs(signal[k] - signal[k - 1]);
        d > rounding_error && (smallest == 0 || d < smallest))
      smallest = d;
  return smallest;
}

/// Whether a shaft turns by more than two encoder steps per row, averaged over ten rows on both
/// sides.
class Turning {
 public:
  explicit Turning(const Episode& e) {
    for (const auto& s : e.actuators)
      if (!s.shaft_rad.empty()) shafts_.push_back({&s.shaft_rad, step_of(s.shaft_rad)});
  }
  bool at(std::size_t k) const {
    constexpr std::size_t reach = 10;  // rows; chosen
    constexpr double steps = 2;        // per row; chosen
    return std::ranges::any_of(shafts_, [&](const auto& shaft) {
      const Signal& x = *shaft.first;
      return k >= reach && k + reach < x.size() &&
             std::abs(x[k + reach] - x[k - reach]) > 2 * reach * steps * shaft.second &&
             shaft.second > 0;
    });
  }

 private:
  std::vector<std::pair<const Signal*, double>> shafts_;
};

/// Interpolates between two valid rows.
void fill(Signal& signal, std::size_t before, std::size_t after) {
  for (std::size_t k = before + 1; k < after; ++k)
    signal[k] = signal[before] +
                (signal[after] - signal[before]) * double(k - before) / double(after - before);
}

void repair_repeated_rows(Episode& e) {
  constexpr std::size_t longest_interpolated = 10;  // rows; chosen
  const auto same = repeats(e);
  for (std::size_t k = 1; k < e.rows; ++k) {
    if (!same[k]) continue;
    const std::size_t before = k - 1;
    while (k < e.rows && same[k]) ++k;
    const auto remove = [&](Signal& s) {
      if (!s.empty())
        std::fill(s.begin() + long(before) + 1, s.begin() + long(k), recording::not_taken);
    };
    for (Signal* s : positions_of(e))
      if (k < e.rows && k - before <= longest_interpolated + 1) fill(*s, before, k);
      else remove(*s);
    for (auto& s : e.actuators) remove(s.voltage_V), remove(s.current_A);
  }
}

/// The high-pass part e of an angle, and its speed.
struct Filtered {
  Signal high_pass, speed;
};

std::vector<Filtered> filtered(const Episode& e) {
  std::vector<const Signal*> angles;
  for (const auto& s : e.actuators)
    if (!s.shaft_rad.empty()) angles.push_back(&s.shaft_rad);
  for (const auto& j : e.joints)
    if (!j.angle_rad.empty()) angles.push_back(&j.angle_rad);
  std::vector<Filtered> all;
  for (const Signal* angle : angles) {
    const Signal& x = *angle;
    Filtered& u = all.emplace_back();
    u.high_pass.resize(x.size()), u.speed.resize(x.size());
    for (std::size_t k = 2; k + 2 < x.size(); ++k) {
      u.high_pass[k] = x[k] - (4 * (x[k - 1] + x[k + 1]) - (x[k - 2] + x[k + 2])) / 6;
      u.speed[k] = (x[k + 2] - x[k - 2]) / (4 * e.period_s);
    }
  }
  return all;
}

}  // namespace

RepeatedRows repeated_rows(std::span<const Episode> episodes) {
  constexpr double smallest_fraction = 0.005;  // of the rows in which a shaft turns; chosen
  double turning = 0, lost = 0;
  RepeatedRows repeated;
  for (Episode e : episodes) {
    const auto same = repeats(e);
    const Turning turns(e);
    std::size_t run = 0;
    for (std::size_t k = 0; k < e.rows; ++k) {
      run = same[k] ? run + 1 : 0;
      if (!turns.at(k)) continue;
      ++turning, lost += same[k];
      repeated.longest = std::max(repeated.longest, run);
    }
  }
  if (turning > 0 && lost > smallest_fraction * turning) repeated.fraction = lost / turning;
  else repeated.longest = 0;
  return repeated;
}

double row_jitter_s(std::span<const Episode> episodes) {
  constexpr double filter_gain = 35.0 / 18;
  constexpr double clear_sigmas = 6, smallest_jitter_s = 1e-4;  // chosen
  double numerator = 0, error = 0, denominator = 0;
  for (const Episode& e : episodes) {
    const auto all = filtered(e);
    for (std::size_t a = 0; a < all.size(); ++a)
      for (std::size_t b = a + 1; b < all.size(); ++b)
        for (std::size_t k = 2; k + 2 < e.rows; ++k) {
          const double weight = all[a].speed[k] * all[b].speed[k];
          const double product = all[a].high_pass[k] * all[b].high_pass[k] * weight;
          if (std::isnan(product)) continue;
          numerator += product, error += product * product, denominator += weight * weight;
        }
  }
  if (!(denominator > 0) || !(numerator > clear_sigmas * std::sqrt(error))) return 0;
  const double spread_s = std::sqrt(12 * numerator / (filter_gain * denominator));
  return spread_s > smallest_jitter_s ? spread_s : 0;
}

void repair_defective_rows(std::vector<Episode>& episodes, std::vector<std::string>& remarks) {
  const RepeatedRows repeated = repeated_rows(episodes);
  if (repeated.fraction > 0) {
    for (Episode& e : episodes) repair_repeated_rows(e), e.repeated_fraction = repeated.fraction;
    remarks.push_back(
        fmt::format("{:.3g} % of the rows repeat the row before while a shaft turns, up to {} in "
                    "succession: reports were lost; angles and tensions are interpolated, voltages "
                    "and currents of these rows ignored",
                    100 * repeated.fraction, repeated.longest));
  }
  const double spread_s = row_jitter_s(episodes);
  if (spread_s == 0) return;
  for (Episode& e : episodes) e.jitter_s = spread_s;
  remarks.push_back(fmt::format(
      "rows are sampled up to {:.3g} ms later than their time stamps, equally in all shafts and "
      "joints; this jitter is counted as noise",
      1e3 * spread_s));
}

}  // namespace sim::estimation
