#include "sim/diagnosis/located.hpp"

#include <algorithm>

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

/// What cannot be told apart shares its part of the gap.
void share_first(std::vector<Located>& places, const std::vector<Located>& others) {
  const double share = places[0].share / static_cast<double>(1 + others.size());
  places[0].share = share;
  places.insert(places.begin() + 1, others.begin(), others.end());
  for (std::size_t k = 1; k <= others.size(); ++k) places[k].share = share;
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
  constexpr double near = 0.3, about_as_near = 0.6;  // of the gap; of the nearest's gain; chosen
  const Named* nearest = !ranked.empty() && ranked[0].gain > near ? &ranked[0] : nullptr;
  std::vector<Located> places;
  for (const StageGap& gap : stages) {
    if (!gap.open) continue;
    Located place{gap.stage, gap.on, gap.share, gap.excess_interval,
                  when(evidence, plain, stages, gap.on)};
    if (places.empty() && nearest) {
      place.stage = nearest->stage, place.on = nearest->on;
      places.push_back(place);
      std::vector<Located> others;
      for (const Named& n : ranked)
        if (n.on == nearest->on && n.gain > about_as_near * nearest->gain &&
            n.stage != nearest->stage && !has(others, n.stage, n.on))
          others.push_back({n.stage, n.on, 0, {}, place.when});
      share_first(places, others);
    } else if (!has(places, place.stage, place.on)) {
      places.push_back(place);
    }
  }
  return places;
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
