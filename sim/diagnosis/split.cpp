#include "sim/diagnosis/split.hpp"

#include <algorithm>
#include <cmath>

namespace sim::diagnosis {
namespace {

/// How far the signals of a recording reach: of each kind the 5 % and 95 % marks of its size.
std::vector<std::pair<double, double>> reach(const Episode& episode) {
  std::vector<std::pair<double, double>> all;
  const auto add = [&](const Signal& signal, bool rate) {
    std::vector<double> values;
    for (std::size_t k = 1; k < signal.size(); ++k)
      if (const double v = rate ? signal[k] - signal[k - 1] : signal[k]; !std::isnan(v))
        values.push_back(v);
    std::ranges::sort(values);
    if (values.empty()) all.emplace_back(0, 0);
    else all.emplace_back(values[values.size() / 20], values[values.size() * 19 / 20]);
  };
  for (const ActuatorSignals& a : episode.actuators)
    add(a.tension_N, false), add(a.current_A, false), add(a.shaft_rad, false),
        add(a.shaft_rad, true);
  for (const JointSignals& j : episode.joints) add(j.angle_rad, false), add(j.angle_rad, true);
  return all;
}

}  // namespace

std::vector<std::size_t> Sets::all() const {
  std::vector<std::size_t> all = train;
  all.insert(all.end(), held_out.begin(), held_out.end());
  std::ranges::sort(all);
  all.erase(std::ranges::unique(all).begin(), all.end());
  return all;
}

Sets split(std::span<const Episode> episodes) {
  const std::size_t count = episodes.size();
  std::vector<std::vector<std::pair<double, double>>> reaches;
  for (const Episode& episode : episodes) reaches.push_back(reach(episode));
  std::vector<std::pair<double, std::size_t>> beyond;
  for (std::size_t e = 0; e < count; ++e) {
    double sum = 0;
    for (std::size_t s = 0; s < reaches[e].size(); ++s) {
      double low = 1e300, high = -1e300;
      for (std::size_t other = 0; other < count; ++other)
        if (other != e)
          low = std::min(low, reaches[other][s].first),
          high = std::max(high, reaches[other][s].second);
      const double width = std::max(high - low, 1e-12);
      sum += std::max(0.0, low - reaches[e][s].first) / width +
             std::max(0.0, reaches[e][s].second - high) / width;
    }
    beyond.emplace_back(-sum, e);
  }
  std::ranges::sort(beyond);
  const std::size_t held = count < 2 ? 0 : std::max<std::size_t>(1, count / 3);
  Sets sets;
  for (std::size_t k = 0; k < count; ++k)
    (k < held ? sets.held_out : sets.train).push_back(beyond[k].second);
  std::ranges::sort(sets.train), std::ranges::sort(sets.held_out);
  return sets;
}

Sets hold_out_what_shows(Sets sets, const Trials& plain, const WhereOptions& options) {
  std::vector<std::pair<double, std::size_t>> shows;
  const auto all = sets.all();
  for (const std::size_t e : all) {
    const std::size_t only[] = {e};
    double most = 0;
    for (const StageGap& gap : where(plain, plain.bare(), only, options))
      if (gap.open) most = std::max(most, gap.excess);
    if (most > 0) shows.emplace_back(most, e);
  }
  const bool shown = std::ranges::any_of(
      shows, [&](const auto& s) { return std::ranges::count(sets.held_out, s.second) > 0; });
  if (shown || shows.size() < 2) return sets;
  std::ranges::sort(shows);
  sets.held_out = {shows[shows.size() - 2].second};  // the very best is to learn from
  sets.train = all;
  std::erase(sets.train, sets.held_out[0]);
  return sets;
}

}  // namespace sim::diagnosis
