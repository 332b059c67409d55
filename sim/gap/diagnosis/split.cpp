#include "sim/gap/diagnosis/split.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace sim::diagnosis {
namespace {

/// Range of the signals of a recording: 5 % and 95 % quantiles of each signal.
std::vector<std::pair<double, double>> ranges_of(const residuals::Episode& episode) {
  std::vector<std::pair<double, double>> all;
  const auto add = [&](const residuals::Signal& signal, bool rate) {
    std::vector<double> values;
    for (std::size_t k = 1; k < signal.size(); ++k)
      if (const double v = rate ? signal[k] - signal[k - 1] : signal[k]; !std::isnan(v))
        values.push_back(v);
    std::ranges::sort(values);
    if (values.empty()) all.emplace_back(0, 0);
    else all.emplace_back(values[values.size() / 20], values[values.size() * 19 / 20]);
  };
  for (const residuals::ActuatorSignals& a : episode.actuators)
    add(a.tension_N, false), add(a.current_A, false), add(a.shaft_rad, false),
        add(a.shaft_rad, true);
  for (const residuals::JointSignals& j : episode.joints)
    add(j.angle_rad, false), add(j.angle_rad, true);
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

Sets split(std::span<const residuals::Episode> episodes) {
  const std::size_t count = episodes.size();
  std::vector<std::vector<std::pair<double, double>>> ranges;
  for (const residuals::Episode& episode : episodes) ranges.push_back(ranges_of(episode));
  std::vector<std::pair<double, std::size_t>> excess_of_range;
  for (std::size_t e = 0; e < count; ++e) {
    double sum = 0;
    for (std::size_t s = 0; s < ranges[e].size(); ++s) {
      double low = 1e300, high = -1e300;
      for (std::size_t other = 0; other < count; ++other)
        if (other != e)
          low = std::min(low, ranges[other][s].first),
          high = std::max(high, ranges[other][s].second);
      const double width = std::max(high - low, 1e-12);
      sum += std::max(0.0, low - ranges[e][s].first) / width +
             std::max(0.0, ranges[e][s].second - high) / width;
    }
    excess_of_range.emplace_back(-sum, e);
  }
  std::ranges::sort(excess_of_range);
  const std::size_t held_out_count = count < 2 ? 0 : std::max<std::size_t>(1, count / 3);
  Sets sets;
  for (std::size_t k = 0; k < count; ++k)
    (k < held_out_count ? sets.held_out : sets.train).push_back(excess_of_range[k].second);
  std::ranges::sort(sets.train), std::ranges::sort(sets.held_out);
  return sets;
}

namespace {

/// The recordings that show each open stage.
class Visibility {
 public:
  Visibility(const Sets& sets, const Evaluator& baseline, const LocalizationOptions& options) {
    for (const std::size_t e : sets.all()) {
      const std::size_t only[] = {e};
      gaps_[e] = localize(baseline, baseline.nominal_evaluation(), only, options);
    }
  }

  /// Recordings in which the stage is open, largest excess last.
  std::vector<std::size_t> of(const StageGap& stage) const {
    std::vector<std::pair<double, std::size_t>> showing;
    for (const auto& [e, gaps] : gaps_)
      if (const auto gap = find_stage(gaps, stage.stage, stage.on); gap != gaps.end() && gap->open)
        showing.emplace_back(gap->excess, e);
    std::ranges::sort(showing);
    std::vector<std::size_t> episodes;
    for (const auto& [excess, e] : showing) episodes.push_back(e);
    return episodes;
  }

  bool on_both_sides(const StageGap& stage, const Sets& sets) const {
    const auto showing = of(stage);
    const auto among = [&](const std::vector<std::size_t>& side) {
      return std::ranges::any_of(showing, [&](auto e) { return std::ranges::count(side, e) > 0; });
    };
    return among(sets.train) && among(sets.held_out);
  }

 private:
  std::map<std::size_t, std::vector<StageGap>> gaps_;
};

/// The open stages, largest share first.
std::vector<StageGap> open_stages(const Sets& sets, const Evaluator& baseline,
                                  const LocalizationOptions& options) {
  auto gaps = localize(baseline, baseline.nominal_evaluation(), sets.all(), options);
  std::erase_if(gaps, [](const StageGap& gap) { return !gap.open; });
  return gaps;
}

/// The row at which the sum Σ (z² − 1) of a stage reaches half of its total.
std::size_t middle_row(const Evaluator& baseline, std::size_t episode, const StageGap& stage) {
  const residuals::Explanation& e = baseline.nominal_evaluation().of_episode[episode];
  const auto z = baseline.whitened(baseline.nominal_evaluation(), episode);
  const std::size_t windows = e.rows.size();
  std::vector<double> sum{0};
  for (std::size_t k = 0; k < windows; ++k) {
    double excess = 0;
    for (std::size_t r = 0; r < e.residuals.size(); ++r)
      if (same_stage(e.residuals[r], stage.stage, stage.on) && !std::isnan(z[r * windows + k]))
        excess += z[r * windows + k] * z[r * windows + k] - 1;
    sum.push_back(sum.back() + excess);
  }
  const double half = sum.back() / 2;
  std::size_t k = 1;
  while (k + 1 < windows && sum[k] < half) ++k;
  return e.rows[k];
}

std::pair<residuals::Episode, residuals::Episode> parts_of(const residuals::Episode& total,
                                                           std::size_t row) {
  std::pair<residuals::Episode, residuals::Episode> parts{total, total};
  parts.first.judged_until = parts.second.judged_from = row;
  return parts;
}

/// Whether the stage is open in each part.
bool both_show(const Cut& cut, const Evaluator& baseline, const LocalizationOptions& options) {
  const auto [first, second] = parts_of(baseline.episodes()[cut.episode], cut.row);
  for (const residuals::Episode& part : {first, second}) {
    const auto gaps = localize(baseline.nominal(), std::span(&part, 1), options);
    const auto gap = find_stage(gaps, cut.stage, cut.on);
    if (gap == gaps.end() || !gap->open) return false;
  }
  return true;
}

}  // namespace

Sets hold_out_visible(Sets sets, const Evaluator& baseline, const LocalizationOptions& options) {
  const auto open = open_stages(sets, baseline, options);
  const Visibility visibility(sets, baseline, options);
  if (open.empty() || visibility.on_both_sides(open[0], sets)) return sets;
  const auto showing = visibility.of(open[0]);
  if (showing.size() < 2) return sets;
  const auto all = sets.all();
  sets.held_out = {showing[showing.size() - 2]};  // the largest excess is for training
  sets.train = all;
  std::erase(sets.train, sets.held_out[0]);
  return sets;
}

std::vector<Cut> cuts(const Sets& sets, const Evaluator& baseline,
                      const LocalizationOptions& options) {
  constexpr double least_share = 0.05;  // of the gap, for which a recording is cut; chosen
  const Visibility visibility(sets, baseline, options);
  std::vector<Cut> cuts;
  for (const StageGap& stage : open_stages(sets, baseline, options)) {
    const auto showing = visibility.of(stage);
    if (stage.share < least_share || showing.empty() || visibility.on_both_sides(stage, sets))
      continue;
    const Cut cut{showing.back(), middle_row(baseline, showing.back(), stage), stage.stage,
                  stage.on};
    if (std::ranges::count(cuts, cut.episode, &Cut::episode) == 0 &&
        both_show(cut, baseline, options))
      cuts.push_back(cut);
  }
  return cuts;
}

void cut_in_two(const Cut& cut, std::vector<residuals::Episode>& episodes, Sets& sets) {
  auto [first, second] = parts_of(episodes[cut.episode], cut.row);
  episodes[cut.episode] = std::move(first);
  episodes.push_back(std::move(second));
  std::erase(sets.train, cut.episode), std::erase(sets.held_out, cut.episode);
  sets.train.push_back(cut.episode), sets.held_out.push_back(episodes.size() - 1);
}

}  // namespace sim::diagnosis
