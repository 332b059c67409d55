#include "sim/gap/diagnosis/answer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sim::diagnosis {
namespace {
constexpr double method_error = 0.02;     // relative error of the approximation by windows; chosen
constexpr double interval_sigmas = 1.96;  // half width of a 95 % interval
}  // namespace

IdentifiedEffect identified(const effects::Placed& placed) {
  const effects::About& about = effects::about(placed.effect);
  IdentifiedEffect n{
      std::string(about.type), placed.on, about.stage, {}, {}, {}, {}, 0, {}, false, placed};
  effects::AnyEffect copy = placed.effect;
  for (const effects::Parameter& p : effects::parameters(copy))
    if (p.fitted)
      n.names.emplace_back(p.name), n.values.push_back(*p.value), n.bounds.push_back(p.bounds);
  n.intervals.resize(n.values.size());
  return n;
}

IdentifiedEffect identified(const Ranked& ranked, double least_gain) {
  IdentifiedEffect n = identified(ranked.fit.placed);
  for (std::size_t k = 0; k < n.values.size(); ++k) {
    const double half_width =
        interval_sigmas * ranked.fit.sigmas[k] + method_error * std::abs(n.values[k]);
    n.intervals[k] = {std::max(n.values[k] - half_width, n.bounds[k].low),
                      std::min(n.values[k] + half_width, n.bounds[k].high)};
  }
  n.gain = ranked.gain, n.gain_interval = ranked.gain_interval;
  n.supported = ranked.gain_interval.low > least_gain && ranked.relieves();
  return n;
}

IdentifiedEffect identified(const BusFit& fit) {
  IdentifiedEffect n = identified(fit.placed);
  const double margin = method_error * std::abs(fit.value);  // ages are integer numbers of ticks
  n.intervals[0] = {fit.low - margin, fit.high + margin};
  n.gain = fit.gain, n.gain_interval = {fit.gain, fit.gain}, n.supported = fit.supported;
  return n;
}

std::string undetermined(const IdentifiedEffect& effect) {
  effects::AnyEffect neutral = *effects::neutral(effect.type);
  bool contains_neutral = !effect.values.empty();
  std::size_t k = 0;
  for (const effects::Parameter& p : effects::parameters(neutral)) {
    if (!p.fitted) continue;
    const Interval& interval = effect.intervals[k];
    const double value = effect.values[k];
    if (is_at_bound(p, value)) return fmt::format("{} is at its bound, {:.3g}", p.name, value);
    const double rounding = 1e-6 * (p.bounds.high - p.bounds.low);
    const bool at_end = value <= p.bounds.low + rounding || value >= p.bounds.high - rounding;
    const double tolerance = at_end ? rounding : 0;  // a neutral value at a bound
    contains_neutral &=
        interval.low <= *p.value + tolerance && *p.value - tolerance <= interval.high;
    ++k;
  }
  return contains_neutral ? "its interval contains the neutral value" : "";
}

bool is_at_bound(const IdentifiedEffect& effect) {
  effects::AnyEffect neutral = *effects::neutral(effect.type);
  std::size_t k = 0;
  for (const effects::Parameter& p : effects::parameters(neutral))
    if (p.fitted && is_at_bound(p, effect.values[k++])) return true;
  return false;
}

void control_discoveries(const std::vector<Ranked>& ranked, std::vector<IdentifiedEffect>& names) {
  constexpr double false_discovery_rate = 0.05;
  std::vector<std::pair<double, std::size_t>> p_values;
  for (std::size_t k = 0; k < ranked.size(); ++k) p_values.emplace_back(ranked[k].p_value, k);
  std::ranges::sort(p_values);
  const auto count = static_cast<double>(p_values.size());
  std::size_t discoveries = 0;
  for (std::size_t k = 0; k < p_values.size(); ++k)
    if (p_values[k].first <= false_discovery_rate * static_cast<double>(k + 1) / count)
      discoveries = k + 1;
  for (std::size_t k = discoveries; k < p_values.size(); ++k)
    names[p_values[k].second].supported = false;
}

}  // namespace sim::diagnosis
