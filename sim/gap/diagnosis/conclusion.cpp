#include "sim/gap/diagnosis/conclusion.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace sim::diagnosis {
namespace {

Verdict judge(const Selection& selection, const Observed& observed,
              const std::vector<StageGap>& stages) {
  const bool left = std::ranges::any_of(selection.left, &StageGap::open);
  const bool coarse_alone = !observed.sensors.empty() && !left;  // and that is all held out shows
  if (selection.gap && !coarse_alone)
    return selection.explained() ? Verdict::supported
           : selection.shown     ? Verdict::none_of_the_known
                                 : Verdict::not_identifiable;
  if (observed.bus_differs()) return Verdict::supported;
  if (observed.bus_unexplained()) return Verdict::none_of_the_known;
  if (std::ranges::none_of(stages, &StageGap::judged)) return Verdict::not_identifiable;
  return observed.sensors.empty() ? Verdict::no_gap : Verdict::supported;
}

/// The bus changes no residual: it comes last where others do.
void add_bus(const Observed& observed, Diagnosis& d) {
  if (!observed.bus_differs()) return;
  constexpr double indistinguishable = 0.01;  // of the likelihood's gain; chosen
  d.answer.push_back(observed.bus[0]);
  for (std::size_t k = 1; k < observed.bus.size(); ++k)
    if (observed.bus[0].gain - observed.bus[k].gain < indistinguishable)
      d.answer.back().alternatives.push_back(observed.bus[k]);
}

void put_first(std::vector<Named>& into, const std::vector<Named>& what) {
  into.insert(into.begin(), what.begin(), what.end());
}

void add_ranked(const Observed& observed, Diagnosis& d) {
  put_first(d.ranked, observed.bus);
  put_first(d.ranked, observed.sensors);
}

/// What was seen without a fit comes first where it is all there is to say, the bus last where
/// residuals have a cause of their own: it changes none of them.
void add_observed(const Observed& observed, Diagnosis& d) {
  put_first(d.answer, observed.sensors);
  add_ranked(observed, d);
  add_bus(observed, d);
}

/// It changes no residual, so it is the whole gap where they are closed.
void add_unexplained_bus(const std::string& robot, const Observed& observed, Diagnosis& d) {
  d.warnings.push_back(fmt::format(
      "in {:.0f} % of the ticks an ECU did not follow the newest command, and no effect of the bus "
      "explains the age of those that it followed",
      100 * observed.late));
  if (d.where.empty()) d.where.push_back({effects::Stage::bus, robot, 1, {1, 1}, {}});
}

/// Why constants that would explain the gap are not the answer.
void warn_of_unknown_law(const std::vector<StageGap>& left, Diagnosis& d) {
  const auto stage = std::ranges::max_element(left, {}, &StageGap::excess);
  d.warnings.push_back(
      fmt::format("only the {} of {} has a gap: an unknown law there is likelier than several "
                  "wrong constants that cancel at every other stage",
                  effects::word(stage->stage), stage->on));
}

}  // namespace

void conclude(const Question& q, const Built& built, Selection selection, Diagnosis& d) {
  d.verdict = !d.judged_apart()   ? Verdict::not_identifiable
              : built.explained() ? Verdict::supported
                                  : Verdict::none_of_the_known;
  d.ranked = selection.ranked;
  add_ranked(q.observed, d);
  d.answer = built.answer, d.constants = built.constants, d.as_built = built.robot;
  d.interaction = built.interaction;
  if (built.unknown_law) warn_of_unknown_law(built.left, d);
  put_first(d.answer, q.observed.sensors);
  add_bus(q.observed, d);
  if (built.explained() && !d.answer.empty())
    d.where = where_of_answer(q.evidence, q.plain, d.stages, d.answer);
  else if (built.explained()) d.where = built.off;
  for (const StageGap& gap : built.left)
    if (gap.open && !built.explained())
      d.where.push_back({gap.stage, gap.on, gap.share, {0, 1}, {}});
  selection.answer = built.answer, selection.left = built.left,
  selection.trial = built.trials.bare();
  d.unexplained = unexplained(q.evidence, built.trials, selection);
  d.channels = closed_by_stage(q.evidence, q.plain, built.trials, built.trials.bare());
  d.overall = closed_overall(q.evidence, q.plain, built.trials, built.trials.bare());
  d.worst = worst_moments(q.evidence, q.plain, built.trials.bare(), d.stages);
}

void conclude(const Question& q, const Selection& selection, Diagnosis& d) {
  const Verdict verdict = judge(selection, q.observed, d.stages);
  const bool explained = verdict == Verdict::supported;
  d.verdict = explained && !d.judged_apart() ? Verdict::not_identifiable : verdict;
  d.ranked = selection.ranked, d.answer = selection.answer, d.interaction = selection.interaction;
  add_observed(q.observed, d);
  if (verdict == Verdict::not_identifiable)
    d.warnings.emplace_back(
        selection.gap
            ? "the recordings held out show too little of the gap to judge what causes it; "
              "record more motion that excites it, see where and when"
            : "nothing could be judged; record all signals, of motions of some seconds");
  d.where = explained ? where_of_answer(q.evidence, q.plain, d.stages, d.answer)
                      : where_of_stages(q.evidence, q.plain, d.stages, d.ranked);
  if (q.observed.bus_unexplained()) add_unexplained_bus(q.evidence.robot.name, q.observed, d);
  if (selection.gap) d.unexplained = unexplained(q.evidence, q.known, selection);
  d.channels = closed_by_stage(q.evidence, q.plain, q.known, selection.trial);
  d.overall = closed_overall(q.evidence, q.plain, q.known, selection.trial);
  d.worst = worst_moments(q.evidence, q.plain, selection.trial, d.stages);
}

}  // namespace sim::diagnosis
