#include "sim/gap/diagnosis/conclusion.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace sim::diagnosis {
namespace {

Verdict verdict_of(const Selection& selection, const Detected& detected,
                   const std::vector<StageGap>& stages) {
  const bool remaining = std::ranges::any_of(selection.remaining, &StageGap::open);
  const bool coarse_sensors_explain = !detected.sensors.empty() && !remaining;
  if (selection.gap && !coarse_sensors_explain)
    return selection.explained()  ? Verdict::supported
           : selection.is_visible ? Verdict::none_of_the_known
                                  : Verdict::not_identifiable;
  if (detected.bus_differs()) return Verdict::supported;
  if (detected.bus_unexplained()) return Verdict::none_of_the_known;
  if (std::ranges::none_of(stages, &StageGap::judged)) return Verdict::not_identifiable;
  return detected.sensors.empty() ? Verdict::no_gap : Verdict::supported;
}

/// Adds the bus effect after the other effects because it changes no residual.
void add_bus(const Detected& detected, Diagnosis& d) {
  if (!detected.bus_differs()) return;
  constexpr double indistinguishable = 0.01;  // of the likelihood's gain; chosen
  d.answer.push_back(detected.bus[0]);
  for (std::size_t k = 1; k < detected.bus.size(); ++k)
    if (detected.bus[0].gain - detected.bus[k].gain < indistinguishable)
      d.answer.back().alternatives.push_back(detected.bus[k]);
}

void put_first(std::vector<IdentifiedEffect>& effects, const std::vector<IdentifiedEffect>& added) {
  effects.insert(effects.begin(), added.begin(), added.end());
}

void add_ranked(const Detected& detected, Diagnosis& d) {
  put_first(d.ranked, detected.bus);
  put_first(d.ranked, detected.sensors);
}

/// Adds the detected effects: coarse sensors first, the bus last because it changes no residual.
void add_detected(const Detected& detected, Diagnosis& d) {
  put_first(d.answer, detected.sensors);
  add_ranked(detected, d);
  add_bus(detected, d);
}

/// Attributes the whole gap to the bus if no stage is open. The bus changes no residual.
void add_unexplained_bus(const std::string& robot, const Detected& detected, Diagnosis& d) {
  d.warnings.push_back(fmt::format(
      "bus: in {:.0f} % of the ticks an ECU followed an old command, and no effect of the library "
      "explains the ages; check the bus load and the sender's timing",
      100 * detected.delayed_fraction));
  if (d.where.empty()) d.where.push_back({effects::Stage::bus, robot, 1, {1, 1}, {}});
}

/// Warns that constants that would explain the gap are not the answer.
void warn_of_unknown_law(const std::vector<StageGap>& remaining, Diagnosis& d) {
  const auto stage = std::ranges::max_element(remaining, {}, &StageGap::excess);
  d.warnings.push_back(
      fmt::format("only the {} of {} has a gap: an unknown law there is likelier than several "
                  "wrong constants whose errors cancel at every other stage; inspect that part",
                  effects::word(stage->stage), stage->on));
}

}  // namespace

void conclude(const Question& q, const JointEstimate& built, Selection selection, Diagnosis& d) {
  d.verdict = !d.uses_held_out_data() ? Verdict::not_identifiable
              : built.explained()     ? Verdict::supported
                                      : Verdict::none_of_the_known;
  d.ranked = selection.ranked;
  add_ranked(q.detected, d);
  d.answer = built.answer, d.constants = built.constants, d.as_built = built.robot;
  d.interaction = built.interaction;
  if (built.unknown_law) warn_of_unknown_law(built.remaining, d);
  put_first(d.answer, q.detected.sensors);
  add_bus(q.detected, d);
  if (built.explained() && !d.answer.empty())
    d.where = attribute_to_answer(q.problem, q.baseline, d.stages, d.answer);
  else if (built.explained()) d.where = built.deviating_parts;
  for (const StageGap& gap : built.remaining)
    if (gap.open && !built.explained())
      d.where.push_back({gap.stage, gap.on, gap.share, {0, 1}, {}});
  selection.answer = built.answer, selection.remaining = built.remaining,
  selection.evaluation = built.evaluator.nominal_evaluation();
  d.unexplained = unexplained(q.problem, built.evaluator, selection);
  d.channels =
      closed_by_stage(q.problem, q.baseline, built.evaluator, built.evaluator.nominal_evaluation());
  d.overall =
      closed_overall(q.problem, q.baseline, built.evaluator, built.evaluator.nominal_evaluation());
  d.worst = worst_windows(q.problem, q.baseline, built.evaluator.nominal_evaluation(), d.stages);
}

void conclude(const Question& q, const Selection& selection, Diagnosis& d) {
  const Verdict verdict = verdict_of(selection, q.detected, d.stages);
  const bool explained = verdict == Verdict::supported;
  d.verdict = explained && !d.uses_held_out_data() ? Verdict::not_identifiable : verdict;
  d.ranked = selection.ranked, d.answer = selection.answer, d.interaction = selection.interaction;
  add_detected(q.detected, d);
  if (verdict == Verdict::not_identifiable)
    d.warnings.emplace_back(
        selection.gap
            ? "the held-out recordings show too little of the gap to identify its cause; record "
              "more motions like those under `where`, `when` of diagnosis.json"
            : "no stage could be evaluated; record all signals during motions of several seconds");
  d.where = explained ? attribute_to_answer(q.problem, q.baseline, d.stages, d.answer)
                      : attribute_to_parts(q.problem, q.baseline, d.stages, d.ranked);
  if (q.detected.bus_unexplained()) add_unexplained_bus(q.problem.robot.name, q.detected, d);
  if (selection.gap) d.unexplained = unexplained(q.problem, q.corrected, selection);
  d.channels = closed_by_stage(q.problem, q.baseline, q.corrected, selection.evaluation);
  d.overall = closed_overall(q.problem, q.baseline, q.corrected, selection.evaluation);
  d.worst = worst_windows(q.problem, q.baseline, selection.evaluation, d.stages);
}

}  // namespace sim::diagnosis
