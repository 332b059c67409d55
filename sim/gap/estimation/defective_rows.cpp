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

/// What changes little from row to row.
std::vector<Signal*> positions_of(Episode& e) {
  std::vector<Signal*> all = sensors_of(e);
  for (auto& s : e.actuators) std::erase(all, &s.current_A);
  return all;
}

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

/// The finest step of a signal.
double step_of(const Signal& signal) {
  double least = 0;
  for (std::size_t k = 1; k < signal.size(); ++k)
    if (const double d = std::abs(signal[k] - signal[k - 1]);
        d > 1e-12 && (least == 0 || d < least))
      least = d;
  return least;
}

/// Whether a shaft turns by more than two of its steps a row, in the mean over ten rows to both sides.
class Turning {
 public:
  explicit Turning(const Episode& e) {
    for (const auto& s : e.actuators)
      if (!s.shaft_rad.empty()) shafts_.push_back({&s.shaft_rad, step_of(s.shaft_rad)});
  }
  bool at(std::size_t k) const {
    constexpr std::size_t reach = 10;
    constexpr double steps = 2;  // a row
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

void fill(Signal& signal, std::size_t from, std::size_t to) {  // rows between that are known
  for (std::size_t k = from + 1; k < to; ++k)
    signal[k] = signal[from] + (signal[to] - signal[from]) * double(k - from) / double(to - from);
}

void repair_repeated_rows(Episode& e) {
  constexpr std::size_t longest = 10;  // rows; chosen
  const auto same = repeats(e);
  for (std::size_t k = 1; k < e.rows; ++k) {
    if (!same[k]) continue;
    const std::size_t before = k - 1;
    while (k < e.rows && same[k]) ++k;
    const auto forget = [&](Signal& s) {
      if (!s.empty())
        std::fill(s.begin() + long(before) + 1, s.begin() + long(k), recording::not_taken);
    };
    for (Signal* s : positions_of(e))
      if (k < e.rows && k - before <= longest + 1) fill(*s, before, k);
      else forget(*s);
    for (auto& s : e.actuators) forget(s.voltage_V), forget(s.current_A);
  }
}

/// What a shaft or joint does apart from its smooth way, and its speed.
struct Uneven {
  Signal apart, speed;
};

std::vector<Uneven> uneven(const Episode& e) {
  std::vector<const Signal*> angles;
  for (const auto& s : e.actuators)
    if (!s.shaft_rad.empty()) angles.push_back(&s.shaft_rad);
  for (const auto& j : e.joints)
    if (!j.angle_rad.empty()) angles.push_back(&j.angle_rad);
  std::vector<Uneven> all;
  for (const Signal* angle : angles) {
    const Signal& x = *angle;
    Uneven& u = all.emplace_back();
    u.apart.resize(x.size()), u.speed.resize(x.size());
    for (std::size_t k = 2; k + 2 < x.size(); ++k) {
      u.apart[k] = x[k] - (4 * (x[k - 1] + x[k + 1]) - (x[k - 2] + x[k + 2])) / 6;
      u.speed[k] = (x[k + 2] - x[k - 2]) / (4 * e.period_s);
    }
  }
  return all;
}

}  // namespace

RepeatedRows repeated_rows(std::span<const Episode> episodes) {
  constexpr double least = 0.005;  // of the rows in which a shaft turns; chosen
  double rows = 0, all = 0, turning = 0, lost = 0;
  RepeatedRows found;
  for (Episode e : episodes) {
    const auto same = repeats(e);
    const Turning turns(e);
    std::size_t run = 0;
    for (std::size_t k = 0; k < e.rows; ++k) {
      ++rows, all += same[k];
      run = same[k] ? run + 1 : 0;
      if (!turns.at(k)) continue;
      ++turning, lost += same[k];
      found.longest = std::max(found.longest, run);
    }
  }
  if (turning > 0 && lost > least * turning) found.share = lost / turning;
  else found.longest = 0;
  return found;
}

double row_jitter_s(std::span<const Episode> episodes) {
  constexpr double of_filter = 35.0 / 18, clear = 6, least_s = 1e-4;  // the last two chosen
  double numerator = 0, error = 0, denominator = 0;
  for (const Episode& e : episodes) {
    const auto all = uneven(e);
    for (std::size_t a = 0; a < all.size(); ++a)
      for (std::size_t b = a + 1; b < all.size(); ++b)
        for (std::size_t k = 2; k + 2 < e.rows; ++k) {
          const double weight = all[a].speed[k] * all[b].speed[k];
          const double product = all[a].apart[k] * all[b].apart[k] * weight;
          if (std::isnan(product)) continue;
          numerator += product, error += product * product, denominator += weight * weight;
        }
  }
  if (!(denominator > 0) || !(numerator > clear * std::sqrt(error))) return 0;
  const double spread_s = std::sqrt(12 * numerator / (of_filter * denominator));
  return spread_s > least_s ? spread_s : 0;
}

void repair_defective_rows(std::vector<Episode>& episodes, std::vector<std::string>& remarks) {
  const RepeatedRows repeated = repeated_rows(episodes);
  if (repeated.share > 0) {
    for (Episode& e : episodes) repair_repeated_rows(e), e.repeated_share = repeated.share;
    remarks.push_back(
        fmt::format("{:.3g} % of the rows repeat the row before while shafts turn, up to {} in a "
                    "row: reports were "
                    "lost; filled in from their neighbours",
                    100 * repeated.share, repeated.longest));
  }
  const double spread_s = row_jitter_s(episodes);
  if (spread_s == 0) return;
  for (Episode& e : episodes) e.jitter_s = spread_s;
  remarks.push_back(fmt::format(
      "rows are taken up to {:.3g} ms later than they are stamped, by all shafts and joints alike: "
      "counted as noise",
      1e3 * spread_s));
}

}  // namespace sim::estimation
