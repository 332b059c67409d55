#include "sim/diagnosis/diagnose.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "sim/diagnosis/identifiability.hpp"
#include "sim/diagnosis/residual_split.hpp"

namespace sim::diagnosis {
namespace {

/// Each once: a recording that is cut is two episodes.
std::vector<std::string> names_of(const Evidence& evidence, const std::vector<std::size_t>& set) {
  std::vector<std::string> names;
  for (const std::size_t k : set)
    if (std::ranges::count(names, evidence.episodes[k].name) == 0)
      names.push_back(evidence.episodes[k].name);
  return names;
}

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

/// The best effect alone leaves nothing but noise, and the robot is one on which the joint estimate
/// takes many minutes: its time grows with the square of the actuators.
bool leaves_noise_on_large_robot(const Evidence& evidence, const Selection& selection) {
  constexpr std::size_t large = 12;  // actuators; chosen
  constexpr double noise = 0.2;      // of its square; chosen
  return evidence.robot.actuators.size() > large && selection.explained() &&
         std::ranges::none_of(selection.left, [](const StageGap& g) { return g.excess > noise; });
}

/// Both name the same one effect, and say that it explains.
bool agree(const Built& built, const Selection& selection) {
  return built.exact && built.answer.size() == 1 && selection.explained() &&
         selection.answer.size() == 1 && built.answer[0].is(selection.answer[0].placed);
}

/// Each cause of an answer at a place of its own: several at one place can bend to nearly any law.
bool apart(const std::vector<Named>& answer) {
  for (std::size_t a = 0; a < answer.size(); ++a)
    for (std::size_t b = a + 1; b < answer.size(); ++b)
      if (answer[a].stage == answer[b].stage && answer[a].on == answer[b].on) return false;
  return true;
}

std::ptrdiff_t open_in(const std::vector<StageGap>& gaps) {
  return std::ranges::count_if(gaps, &StageGap::open);
}

/// Effects that either way cannot distinguish from the answer.
void add_indistinguishable(Named& answer, const Named& other) {
  for (const Named& n : other.alternatives)
    if (std::ranges::none_of(answer.alternatives, [&](const Named& a) { return a.is(n.placed); }))
      answer.alternatives.push_back(n);
}

/// What a question is answered from.
struct Question {
  const Evidence& evidence;
  const erp::Robot& robot;  ///< with what was seen without a fit
  const Trials& plain;      ///< of the robot as it is given
  const Trials& known;      ///< of `robot`
  const Observed& observed;
};

/// Why constants that would explain the gap are not the answer.
void warn_of_unknown_law(const std::vector<StageGap>& left, Diagnosis& d) {
  const auto stage = std::ranges::max_element(left, {}, &StageGap::excess);
  d.warnings.push_back(
      fmt::format("only the {} of {} has a gap: an unknown law there is likelier than several "
                  "wrong constants that cancel at every other stage",
                  effects::word(stage->stage), stage->on));
}

/// Takes the answer of sim/gap: effects and constants estimated together.
void take(const Question& q, const Built& built, Selection selection, Diagnosis& d) {
  d.verdict = !d.judged_apart()   ? Verdict::not_identifiable
              : built.explained() ? Verdict::supported
                                  : Verdict::none_of_the_known;
  d.answer = built.answer, d.constants = built.constants, d.as_built = built.robot;
  d.interaction = built.interaction;
  if (built.unknown_law) warn_of_unknown_law(built.left, d);
  put_first(d.answer, q.observed.sensors);
  add_bus(q.observed, d);
  if (built.explained() && !d.answer.empty())
    d.where = where_of_answer(q.evidence, q.plain, d.stages, d.answer);
  else if (built.explained())  // by constants, of which none alone is the cause
    for (const StageGap& gap : d.stages)
      if (gap.open) d.where.push_back({gap.stage, gap.on, gap.share, {0, 1}, {}});
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

/// Takes the answer of a selection of effects on the robot's constants as given.
void take(const Question& q, const Selection& selection, Diagnosis& d) {
  const Verdict verdict = judge(selection, q.observed, d.stages);
  const bool explained = verdict == Verdict::supported;
  d.verdict = explained && !d.judged_apart() ? Verdict::not_identifiable : verdict;
  d.answer = selection.answer, d.interaction = selection.interaction;
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

/// Whether an answer of sim/gap needs no comparison with one of effects on the constants as given: it
/// explains, with one effect alone or with estimated constants; of a drive, whose friction is all at one
/// place, it leaves only noise.
bool stands(const Evidence& evidence, const Built& built) {
  if (evidence.robot.drives.empty())
    return built.explained() && (!built.exact || built.answer.size() == 1);
  const double noise = evidence.options.together.excess;
  return built.explained() &&
         std::ranges::all_of(built.left, [&](const StageGap& g) { return g.excess < noise; });
}

/// The robot as built first, unless the effects alone explain as well or better.
void answer(const Question& q, Diagnosis& d) {
  const Evidence& evidence = q.evidence;
  const bool coarse = !q.observed.sensors.empty();
  Selection selection =
      select(evidence, q.known, d.stages, coarse ? Depth::full : Depth::best_alone);
  std::optional<Built> built;
  if (selection.gap && selection.shown && !(coarse && selection.explained()) &&
      !leaves_noise_on_large_robot(evidence, selection))
    built.emplace(as_built(evidence, q.robot, q.plain, selection.answer));
  if (built && agree(*built, selection)) {
    add_indistinguishable(selection.answer[0], built->answer[0]);
    built.reset();
  } else if (built && built->unknown_law) {
    if (selection.explained()) built.reset();  // by one effect
  } else if (built && !stands(evidence, *built)) {
    selection = select(evidence, q.known, d.stages, Depth::full, std::move(selection));
    const bool leaves_less = open_in(built->left) < open_in(selection.left);
    if (selection.explained() || !leaves_less || !apart(built->answer)) built.reset();
  }
  d.ranked = selection.ranked;
  if (!built) return take(q, selection, d);
  add_ranked(q.observed, d);
  take(q, *built, std::move(selection), d);
}

/// The robot with what was seen without a fit.
erp::Robot as_observed(const erp::Robot& robot, const Observed& observed) {
  erp::Robot known = robot;
  for (const Named& n : observed.sensors) known.effects.push_back(effects::written(n.placed));
  return known;
}

/// Of recordings that are sorted, and of what was cut in two for that. `plain`: of the robot as given.
Diagnosis diagnosed(Evidence& evidence, const Trials& plain, const CutRecordings& cut) {
  const erp::Robot& robot = evidence.robot;
  Diagnosis d;
  d.recordings = names_of(evidence, evidence.sets.all());
  d.shared = cut.shared, d.warnings = cut.warnings;
  if (evidence.sets.held_out.empty()) {
    evidence.sets.held_out = evidence.sets.train;
    d.warnings.emplace_back(
        "one recording only, and it was not split: an effect cannot be judged on the data that it "
        "was fitted to; record another");
  }
  d.train = names_of(evidence, evidence.sets.train);
  d.held_out = names_of(evidence, evidence.sets.held_out);
  d.stages = where(plain, plain.bare(), evidence.sets.all(), evidence.where_options());

  const Observed observed = observe(evidence, plain);
  const erp::Robot known = as_observed(robot, observed);
  std::optional<Trials> coarse;
  if (!observed.sensors.empty()) coarse.emplace(known, evidence.episodes, evidence.options.seed);
  const Question question{evidence, known, plain, coarse ? *coarse : plain, observed};
  warn_unjudged(evidence, observed, d);
  answer(question, d);
  drop_alternatives_at_bounds(d.answer);
  require_determined(d);
  require_sampling(plain, d);
  return d;
}

}  // namespace

const char* word(Verdict verdict) {
  constexpr const char* words[] = {"no_gap", "supported", "none_of_the_known", "not_identifiable"};
  return words[static_cast<std::size_t>(verdict)];
}

Diagnosis diagnose(const erp::Robot& robot, std::vector<residuals::Episode> episodes,
                   const DiagnoseOptions& options) {
  if (episodes.empty()) throw std::invalid_argument("no recording");
  Evidence evidence{robot, std::move(episodes), options, {}};
  evidence.sets = first_sets(evidence);
  evidence.tell("residuals", 0.05);
  const auto trials = [&](const erp::Robot& of) {
    return Trials(of, evidence.episodes, options.seed);
  };
  CutRecordings cut;
  std::optional<Trials> plain(trials(robot));
  if (split_by_residual(evidence, *plain, cut)) plain.emplace(trials(robot));
  Diagnosis d = diagnosed(evidence, *plain, cut);
  if (d.verdict == Verdict::none_of_the_known && d.as_built &&
      split_by_residual(evidence, trials(*d.as_built), cut)) {
    plain.emplace(trials(robot));
    d = diagnosed(evidence, *plain, cut);
  }
  evidence.tell("done", 1);
  return d;
}

}  // namespace sim::diagnosis
