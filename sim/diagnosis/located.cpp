#include "sim/diagnosis/located.hpp"

#include <algorithm>
#include <functional>

#include "sim/diagnosis/isolation.hpp"

namespace sim::diagnosis {
namespace {

/// When the residual of what sits there lives, at its most open stage.
std::vector<Region> when(const Evidence& evidence, const Trials& plain,
                         const std::vector<StageGap>& stages, const std::string& on) {
  const auto most =
      std::ranges::find_if(stages, [&](const StageGap& gap) { return gap.open && gap.on == on; });
  if (most == stages.end()) return {};
  return regions(plain, plain.bare(), most->stage, on, evidence.sets.all());
}

bool has(const std::vector<Located>& places, effects::Stage stage, const std::string& on) {
  return find_stage(places, stage, on) != places.end();
}

/// What cannot be told apart shares its part of the gap: each may have all of it, or none.
void share_first(std::vector<Located>& places, const std::vector<Located>& others) {
  const double share = places[0].share / static_cast<double>(1 + others.size());
  places[0].share = share;
  if (!others.empty()) places[0].interval.low = 0;
  places.insert(places.begin() + 1, others.begin(), others.end());
  for (std::size_t k = 1; k <= others.size(); ++k)
    places[k].share = share, places[k].interval = places[0].interval;
}

/// The parts of the chain that could leave the gap, the likeliest first: the one whose effects come
/// nearest to closing it, then the one where it shows.
std::vector<Part> suspects(const Evidence& evidence, const Trials& plain, const Located& widest,
                           const std::vector<Named>& ranked) {
  constexpr double near = 0.3;  // of the gap; chosen
  const auto likelihood = [&](const Part& part) {
    double gain = 0;
    for (const Named& n : ranked)
      if (same_stage(part, n.stage, n.on)) gain = std::max(gain, n.gain);
    return std::pair(gain > near ? gain : 0, same_stage(widest, part.stage, part.on));
  };
  auto parts = isolate(evidence, plain);
  std::ranges::stable_sort(parts, std::greater(), likelihood);
  return parts;
}

}  // namespace

std::vector<Located> where_of_answer(const Evidence& evidence, const Trials& plain,
                                     const std::vector<StageGap>& stages,
                                     const std::vector<Named>& answer,
                                     const std::vector<Named>& confusable) {
  double whole = 0;
  for (const Named& n : answer) whole += std::max(0.0, n.gain);
  std::vector<Located> places, others;
  for (const Named& n : answer) {
    const double share = whole > 0 ? std::max(0.0, n.gain) / whole : 1;
    if (const auto same = find_stage(places, n.stage, n.on); same != places.end())
      same->share += share, same->interval.low += n.gain_interval.low,
          same->interval.high += n.gain_interval.high;
    else
      places.push_back(
          {n.stage, n.on, share, n.gain_interval, when(evidence, plain, stages, n.on)});
  }
  const Located& first = places.at(0);
  for (const Named& n : confusable)
    if (!same_stage(first, n.stage, n.on) && !has(others, n.stage, n.on))
      others.push_back({n.stage, n.on, 0, first.interval, first.when});
  share_first(places, others);
  return places;
}

std::vector<Located> where_of_stages(const Evidence& evidence, const Trials& plain,
                                     const std::vector<StageGap>& stages,
                                     const std::vector<Named>& ranked) {
  std::vector<Located> places;
  double whole = 0;
  for (const StageGap& gap : stages) whole += gap.open ? gap.excess : 0;
  const auto share = [&](double excess) { return std::clamp(excess / whole, 0.0, 1.0); };
  for (const StageGap& gap : stages)
    if (gap.open)
      places.push_back({gap.stage,
                        gap.on,
                        gap.share,
                        {share(gap.excess_interval.low), share(gap.excess_interval.high)},
                        when(evidence, plain, stages, gap.on)});
  if (places.empty()) return places;
  const auto parts = suspects(evidence, plain, places[0], ranked);
  if (parts.empty()) return places;
  const Interval any = parts.size() > 1 ? Interval{0, 1} : Interval{1, 1};
  std::vector<Located> group;
  for (const Part& part : parts)
    group.push_back(
        {part.stage, part.on, 1 / static_cast<double>(parts.size()), any, places[0].when});
  return group;
}

std::vector<Unexplained> unexplained(const Evidence& evidence, const Trials& plain,
                                     const Selection& selection) {
  std::vector<Unexplained> all;
  for (const StageGap& gap : selection.left)
    if (gap.open)
      all.push_back({gap.stage, gap.on, gap.excess,
                     shape_of(plain, selection.trial, gap.stage, gap.on, evidence.sets.train,
                              evidence.sets.held_out)});
  return all;
}

}  // namespace sim::diagnosis
