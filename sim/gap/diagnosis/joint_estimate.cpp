#include "sim/gap/diagnosis/joint_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>

#include "sim/gap/diagnosis/residual_profile.hpp"
#include "sim/gap/diagnosis/selection.hpp"
#include "sim/gap/diagnosis/shapley.hpp"

namespace sim::diagnosis {
namespace {

std::vector<residuals::Episode> episodes_of(const Problem& problem,
                                            const std::vector<std::size_t>& set) {
  std::vector<residuals::Episode> episodes;
  for (const std::size_t k : set) episodes.push_back(problem.episodes[k]);
  return episodes;
}

estimation::EstimateOptions estimate_options(const Problem& problem) {
  return {.threads = problem.options.threads,
          .seed = problem.options.seed,
          .pool = problem.options.pool};
}

std::vector<ConstantEstimate> constants_of(const estimation::AsBuilt& built) {
  std::vector<ConstantEstimate> all;
  for (std::size_t k = 0; k < built.uncertain.constants.size(); ++k) {
    const estimation::Constant& c = built.uncertain.constants[k];
    const double x = built.estimate.point.x[k], half_width = 1.96 * built.estimate.sigma(k);
    all.push_back({c.name,
                   c.on,
                   c.stage,
                   c.nominal,
                   c.tolerance,
                   c.value(x),
                   {c.value(x - half_width), c.value(x + half_width)},
                   estimation::determined(built, k),
                   std::ranges::count(built.beyond_tolerance, k) > 0});
  }
  return all;
}

/// Parts with deviating constants, the largest first. Share: Σ z² of the change by the deviations
/// of a part (linearized), relative to the sum over all parts.
std::vector<Attribution> deviating_parts(const estimation::AsBuilt& built) {
  constexpr double smallest_share = 0.02;  // of a listed part; chosen
  std::map<std::pair<effects::Stage, std::string>, Eigen::VectorXd> change;
  for (std::size_t k = 0; k < built.uncertain.constants.size(); ++k) {
    const estimation::Constant& c = built.uncertain.constants[k];
    const Eigen::VectorXd by =
        built.estimate.jacobian.col(Eigen::Index(k)) * built.estimate.point.x[k];
    Eigen::VectorXd& sum = change[{c.stage, c.on}];
    if (sum.size() == 0) sum = by;
    else sum += by;
  }
  double total = 0;
  for (const auto& [part, z] : change) total += z.squaredNorm();
  std::vector<Attribution> all;
  for (const auto& [part, z] : change)
    if (const double share = z.squaredNorm() / total; share > smallest_share)
      all.push_back({part.first, part.second, share, {0, 1}, {}});
  std::ranges::stable_sort(all, std::greater(), &Attribution::share);
  return all;
}

IdentifiedEffect with_intervals(estimation::SizedEffect sized) {
  constexpr double method_error = 0.02;  // relative error of the approximation by windows; chosen
  IdentifiedEffect n = identified(sized.effect);
  std::size_t p = 0, estimated = 0;
  for (const effects::Parameter& parameter : effects::parameters(sized.effect.effect)) {
    if (!estimation::is_estimated(parameter)) continue;
    const double sigma = sized.sigma[estimated++];
    if (!parameter.fitted) continue;
    const double half_width = 1.96 * sigma + method_error * std::abs(n.values[p]);
    n.intervals[p] = {std::max(n.values[p] - half_width, n.bounds[p].low),
                      std::min(n.values[p] + half_width, n.bounds[p].high)};
    ++p;
  }
  return n;
}

/// The n-th constant beyond its tolerance, with its alternatives.
IdentifiedEffect beyond(const estimation::AsBuilt& built, std::size_t n) {
  const std::size_t k = built.beyond_tolerance[n];
  IdentifiedEffect identified = with_intervals(estimation::as_effect(
      built.uncertain.constants[k], {k, built.estimate.point.x[k], built.estimate.sigma(k)}));
  for (const estimation::SizedEffect& other : built.alternatives[n])
    if (effects::name_of(other.effect) != effects::name_of(identified.placed))
      identified.alternatives.push_back(with_intervals(other));
  return identified;
}

/// The effects of an estimate, with intervals and alternatives.
std::vector<IdentifiedEffect> effects_of(const estimation::AsBuilt& built) {
  std::vector<IdentifiedEffect> all;
  for (const estimation::SizedEffect& sized : estimation::sized_effects(built.estimate)) {
    IdentifiedEffect n = with_intervals(sized);
    for (const estimation::SizedEffect& other : built.indistinguishable[all.size()])
      n.alternatives.push_back(with_intervals(other));
    all.push_back(std::move(n));
  }
  return all;
}

bool is_at_bound(const estimation::Estimate& estimate) {
  return std::ranges::count(estimate.bound, true) > 0;
}

Evaluator evaluator_of(const Problem& problem, const erp::Robot& robot) {
  return {robot, problem.episodes, problem.options.seed};
}

/// The robot as built with a subset of its causes: its effects, then its constants that are far
/// off.
erp::Robot robot_with(const estimation::AsBuilt& built, const std::vector<bool>& is_included) {
  estimation::Point reduced_point = built.estimate.point;
  const std::size_t effects = reduced_point.effects.size();
  for (std::size_t k = is_included.size(); k-- > 0;) {
    if (is_included[k]) continue;
    if (k < effects) reduced_point.effects.erase(reduced_point.effects.begin() + std::ptrdiff_t(k));
    else reduced_point.x[built.beyond_tolerance[k - effects]] = 0;
  }
  return estimation::robot_at(built.uncertain, reduced_point);
}

/// Sets the Shapley value of each cause as its gain. Returns the interaction.
double set_gains(const Problem& problem, const Evaluator& baseline,
                 const estimation::AsBuilt& built, std::vector<IdentifiedEffect>& answer) {
  const auto& held_out = problem.sets.held_out;
  const ShapleyValues each =
      shapley_values(problem, answer.size(), [&](const std::vector<bool>& is_included) {
        residuals::Stages stages(robot_with(built, is_included));
        Evaluation evaluation{{}, std::vector<residuals::Explanation>(problem.episodes.size())};
        for (const std::size_t e : held_out)
          evaluation.of_episode[e] = stages.explain(problem.episodes[e]);
        return baseline.blocks(evaluation, held_out);
      });
  for (std::size_t k = 0; k < answer.size(); ++k) {
    answer[k].gain = each.share[k], answer[k].gain_interval = each.interval[k];
    answer[k].supported = true;
  }
  return each.interaction;
}

/// Excess of a stage without the 1 % of its seconds with the largest residuals. A single event is
/// not a law.
double without_events(const Evaluator& evaluator, const StageGap& gap,
                      const std::vector<std::size_t>& set) {
  auto blocks = evaluator.blocks(
      evaluator.nominal_evaluation(), set,
      [&](const residuals::Residual& r) { return same_stage(r, gap.stage, gap.on); });
  std::ranges::sort(blocks, {}, &ScoreBlock::square);
  blocks.resize(blocks.size() - std::min(blocks.size(), blocks.size() / 100 + 1));
  const ScoreBlock total = sum(blocks);
  return total.windows ? total.square / double(total.windows) - 1 : 0;
}

std::vector<StageGap> remaining_residual(const Problem& problem, const Evaluator& baseline,
                                         const Evaluator& built) {
  const auto held_out = [&](const Evaluator& evaluator) {
    return localize(evaluator, evaluator.nominal_evaluation(), problem.sets.held_out,
                    problem.localization_options());
  };
  const auto before = held_out(baseline);
  auto remaining = held_out(built);
  for (StageGap& gap : remaining) {
    const auto nominal = find_stage(before, gap.stage, gap.on);
    const double usual_excess = without_events(built, gap, problem.sets.held_out);
    gap.open = gap.open && usual_excess > problem.localization_options().practical_excess &&
               stays_open(gap.excess, nominal->excess, problem.options.effect_set, [&] {
                 return explained_by_one_variable(built, built.nominal_evaluation(), gap.stage,
                                                  gap.on, problem.sets);
               });
  }
  return remaining;
}

/// The stage with the largest remaining excess.
StageGap& largest(std::vector<StageGap>& remaining) {
  return *std::ranges::max_element(remaining, {}, &StageGap::excess);
}

}  // namespace

bool ConstantEstimate::differs() const {
  constexpr double sigmas = 3, interval_sigmas = 2 * 1.96;  // width of a 95 % interval
  return std::abs(value - nominal) > sigmas / interval_sigmas * (interval.high - interval.low);
}

bool JointEstimate::explained() const {
  return !at_bound && !unknown_law && std::ranges::none_of(remaining, &StageGap::open);
}

JointEstimate estimate_jointly(const Problem& problem, const erp::Robot& robot,
                               const Evaluator& baseline,
                               const std::vector<IdentifiedEffect>& suggested) {
  const auto train = episodes_of(problem, problem.sets.train),
             held_out = episodes_of(problem, problem.sets.held_out);
  estimation::AsBuiltOptions options{.estimate = estimate_options(problem)};
  for (const IdentifiedEffect& n : suggested) options.suggested.push_back(n.placed);
  options.search.withhold = problem.options.withhold;
  options.search.most_effects = problem.options.most_effects;
  options.search.progress = [&](const std::string& what, double share) {
    problem.report_progress(what, 0.6 + 0.3 * share);
  };
  const estimation::AsBuilt found = estimation::as_built(robot, train, held_out, options);
  std::vector<IdentifiedEffect> answer = effects_of(found);
  for (std::size_t n = 0; n < found.beyond_tolerance.size(); ++n)
    answer.push_back(beyond(found, n));
  const double interaction = set_gains(problem, baseline, found, answer);
  JointEstimate built{.robot = found.robot,
                      .constants = constants_of(found),
                      .answer = std::move(answer),
                      .evaluator = evaluator_of(problem, found.robot),
                      .remaining = {},
                      .exact = found.exact,
                      .unknown_law = found.unknown_law,
                      .at_bound = is_at_bound(found.estimate),
                      .interaction = interaction,
                      .deviating_parts = deviating_parts(found)};
  built.remaining = remaining_residual(problem, baseline, built.evaluator);
  if (built.unknown_law) largest(built.remaining).open = true;
  return built;
}

IdentifiedEffect estimated(const Problem& problem, const erp::Robot& robot,
                           const IdentifiedEffect& effect) {
  return with_intervals(estimation::estimated(robot, episodes_of(problem, problem.sets.train),
                                              effect.placed, estimate_options(problem)));
}

}  // namespace sim::diagnosis
