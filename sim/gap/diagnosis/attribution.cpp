#include "sim/gap/diagnosis/attribution.hpp"

#include <algorithm>
#include <functional>

#include "sim/gap/diagnosis/isolation.hpp"

namespace sim::diagnosis {
namespace {

/// Regions of the residual of `on`, at its open stage with the largest share.
std::vector<Region> regions_of(const Problem& problem, const Evaluator& baseline,
                               const std::vector<StageGap>& stages, const std::string& on) {
  const auto largest =
      std::ranges::find_if(stages, [&](const StageGap& gap) { return gap.open && gap.on == on; });
  if (largest == stages.end()) return {};
  return regions(baseline, baseline.nominal_evaluation(), largest->stage, on, problem.sets.all());
}

/// The place of an effect and those of its alternatives.
std::vector<Part> group_of(const IdentifiedEffect& n) {
  std::vector<Part> group{{n.stage, n.on}};
  for (const IdentifiedEffect& other : n.alternatives)
    if (find_stage(group, other.stage, other.on) == group.end())
      group.push_back({other.stage, other.on});
  return group;
}

/// The part of the gap that an effect closes; 0 for the bus together with other effects.
Interval closed_by(const IdentifiedEffect& n, bool is_single) {
  if (n.stage == effects::Stage::bus && !is_single) return {0, 0};
  return {std::max(0.0, n.gain_interval.low), std::max(0.0, n.gain_interval.high)};
}

void add(std::vector<Attribution>& places, Attribution place) {
  const auto same = find_stage(places, place.stage, place.on);
  if (same == places.end()) return places.push_back(std::move(place));
  same->share += place.share;
  same->interval.low = std::min(1.0, same->interval.low + place.interval.low);
  same->interval.high = std::min(1.0, same->interval.high + place.interval.high);
}

/// Parts that can cause the gap: first those with the effects of highest gain, then the part of the
/// stage with the largest share.
std::vector<Part> suspects(const Problem& problem, const Evaluator& baseline,
                           const Attribution& widest, const std::vector<IdentifiedEffect>& ranked) {
  constexpr double smallest_gain = 0.3;  // that changes the order; chosen
  const auto likelihood = [&](const Part& part) {
    double gain = 0;
    for (const IdentifiedEffect& n : ranked)
      if (same_stage(part, n.stage, n.on)) gain = std::max(gain, n.gain);
    return std::pair(gain > smallest_gain ? gain : 0, same_stage(widest, part.stage, part.on));
  };
  auto parts = isolate(problem, baseline);
  std::ranges::stable_sort(parts, std::greater(), likelihood);
  return parts;
}

}  // namespace

std::vector<Attribution> attribute_to_answer(const Problem& problem, const Evaluator& baseline,
                                             const std::vector<StageGap>& stages,
                                             const std::vector<IdentifiedEffect>& answer) {
  const bool is_single = answer.size() == 1;
  const auto gain = [&](const IdentifiedEffect& n) {
    return closed_by(n, is_single).high > 0 ? std::max(0.0, n.gain) : 0;
  };
  double total = 0;
  for (const IdentifiedEffect& n : answer) total += gain(n);
  const auto share = [&](double part, double others) {
    return part + others > 0 ? part / (part + others) : 1;
  };
  std::vector<Attribution> places;
  for (const IdentifiedEffect& n : answer) {
    const Interval closed = closed_by(n, is_single);
    const double others = total - gain(n);
    const auto group = group_of(n);
    const Interval interval{group.size() > 1 ? 0 : share(closed.low, others),
                            share(closed.high, others)};
    for (const Part& part : group)
      add(places, {part.stage, part.on, share(gain(n), others) / double(group.size()), interval,
                   regions_of(problem, baseline, stages, n.on)});
  }
  return places;
}

std::vector<Attribution> attribute_to_parts(const Problem& problem, const Evaluator& baseline,
                                            const std::vector<StageGap>& stages,
                                            const std::vector<IdentifiedEffect>& ranked) {
  std::vector<Attribution> places;
  double total = 0;
  for (const StageGap& gap : stages) total += gap.open ? gap.excess : 0;
  const auto share = [&](double excess) { return std::clamp(excess / total, 0.0, 1.0); };
  for (const StageGap& gap : stages)
    if (gap.open)
      places.push_back({gap.stage,
                        gap.on,
                        gap.share,
                        {share(gap.excess_interval.low), share(gap.excess_interval.high)},
                        regions_of(problem, baseline, stages, gap.on)});
  if (places.empty()) return places;
  const auto parts = suspects(problem, baseline, places[0], ranked);
  if (parts.empty()) return places;
  const Interval interval = parts.size() > 1 ? Interval{0, 1} : Interval{1, 1};
  std::vector<Attribution> group;
  for (const Part& part : parts)
    group.push_back(
        {part.stage, part.on, 1 / static_cast<double>(parts.size()), interval, places[0].when});
  return group;
}

std::vector<Unexplained> unexplained(const Problem& problem, const Evaluator& evaluator,
                                     const Selection& selection) {
  const Tolerance no_tolerance{problem.options.search.excess, 0, 0};
  const auto remaining =
      selection.explained()
          ? unexplained_stages(problem, evaluator, selection.evaluation, no_tolerance)
          : selection.remaining;
  std::vector<Unexplained> all;
  for (const StageGap& gap : remaining)
    if (gap.open)
      all.push_back({gap.stage, gap.on, gap.excess,
                     residual_profile(evaluator, selection.evaluation, gap.stage, gap.on,
                                      problem.sets.train, problem.sets.held_out)});
  return all;
}

}  // namespace sim::diagnosis
