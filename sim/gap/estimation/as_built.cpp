#include "sim/gap/estimation/as_built.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <span>

#include "sim/gap/estimation/beyond.hpp"
#include "sim/gap/estimation/completion.hpp"

namespace sim::estimation {
namespace {

using effects::Placed;

/// Whether more than three stages, and more than a fifth of all, are open. A few effects do not
/// cause that; chosen.
bool is_widespread(const JudgedEstimate& found) {
  const std::size_t open = count_open_stages(found);
  return open > 3 && 5 * open > found.tolerated.size();
}

/// −2 log evidence by Laplace's approximation. It penalizes constants that the recordings
/// determine.
double model_cost(const AsBuilt& built) {
  const Eigen::Index n = Eigen::Index(built.uncertain.constants.size());
  const Eigen::MatrixXd constant_covariance = built.estimate.covariance.topLeftCorner(n, n);
  return built.cost - constant_covariance.ldlt().vectorD().array().log().sum();
}

/// The index of the open stage if exactly one is open. Empty for drives because all their laws act
/// at one stage.
std::optional<std::size_t> only_open_stage(const Problem& problem, const JudgedEstimate& found) {
  const auto open = open_stages(found);
  if (!problem.nominal.drives.empty() || count_open_stages(found) != 1) return std::nullopt;
  return std::size_t(std::ranges::find(open, true) - open.begin());
}

/// The effect that was added last, and its rivals.
std::vector<Placed> hints_of(const JudgedEstimate& found) {
  std::vector<Placed> hints{found.train.point.effects.back()};
  for (const SizedEffect& rival : found.rivals.back().all) hints.push_back(rival.effect);
  return hints;
}

/// The hypothesis that the robot is as described, except for effects and for constants that are
/// never certain.
class AsDescribed {
 public:
  explicit AsDescribed(const Problem& problem)
      : problem_(problem),
        built_{.uncertain = uncertain_of(problem.nominal, options().search.withhold, true),
               .exact = true},
        search_(problem.train, problem.held_out, built_.uncertain, options().search),
        judged_(search_.with({})) {
    if (const auto stage = only_open_stage(problem_, judged_)) describe_unknown_law(*stage);
  }
  AsDescribed(const AsDescribed&) = delete;

  /// Adds one effect if it relieves a stage. Sets `hints` to the effects that would explain most.
  void find_first() {
    if (!explains())
      if (auto first = search_.with_best_candidate(judged_)) {
        hints = hints_of(*first);
        if (relieves(*first, judged_)) judged_ = std::move(*first);
      }
    if (explains()) compare_suggested();
  }
  void find_others() {
    if (!is_widespread(judged_))
      judged_ = search_.run(std::move(judged_), options().search.most_effects);
    compare_suggested();
  }
  bool explains() const { return !has_open_stage(judged_); }
  AsBuilt answer() const {
    AsBuilt built = built_;
    set_answer(built, judged_);
    built.cost = judged_.cost;
    list_uncertain(built);
    return built;
  }

  /// The hypothesis of a law that the library lacks, at the only stage with a gap; empty if several
  /// stages have a gap.
  std::optional<AsBuilt> unknown_law;
  std::vector<Placed> hints;

 private:
  /// The misfit of the stage is replaced by a price.
  void describe_unknown_law(std::size_t stage) {
    constexpr double price = 30;  // −2 log of the odds of such a law; chosen
    unknown_law = answer();
    unknown_law->unknown_law = true;
    unknown_law->cost += price - misfit(judged_.on_train, problem_.train.residuals(), stage) -
                         misfit(judged_.held_out, problem_.held_out, stage);
  }
  const AsBuiltOptions& options() const { return problem_.options; }
  void compare_suggested() {
    const auto& suggested = options().suggested;
    if (suggested.empty() || are_same(judged_.train.point.effects, suggested)) return;
    if (JudgedEstimate other = search_.with(suggested); other.cost < judged_.cost)
      judged_ = std::move(other);
  }

  const Problem& problem_;
  AsBuilt built_;
  Search search_;
  JudgedEstimate judged_;
};

/// The hypothesis that all constants are uncertain.
class WithTolerances {
 public:
  explicit WithTolerances(const Problem& problem)
      : problem_(problem),
        built_{.uncertain = uncertain_of(problem.nominal, problem.options.search.withhold, false)},
        search_(problem.train, problem.held_out, built_.uncertain, problem.options.search),
        judged_(complete(search_, search_.with({}), problem_, built_)) {}
  WithTolerances(const WithTolerances&) = delete;

  /// Whether the constants alone explain, and more parts of the robot deviate clearly than effects
  /// may be added.
  bool is_sufficient() const {
    constexpr double clear_sigmas = 3;  // standard deviations; chosen
    std::set<std::pair<std::string, effects::Stage>> places;
    for (std::size_t k = 0; k < built_.uncertain.constants.size(); ++k) {
      const Constant& c = built_.uncertain.constants[k];
      if (!is_never_certain(c) && determined(built_, k) > determined_threshold &&
          std::abs(built_.estimate.point.x[k]) > clear_sigmas * built_.estimate.sigma(k))
        places.emplace(c.on, c.stage);
    }
    return !built_.has_open_stage && places.size() > problem_.options.search.most_effects;
  }
  /// Adds effects if the constants alone leave a stage open, or if an effect could replace
  /// constants that are far off.
  AsBuilt answer(const std::vector<Placed>& hints) {
    if (built_.has_open_stage)
      complete(search_, search_.run(std::move(judged_), problem_.options.search.most_effects),
               problem_, built_);
    return answer_or_effect(problem_, built_, hints);
  }

 private:
  const Problem& problem_;
  AsBuilt built_;
  Search search_;
  JudgedEstimate judged_;
};

/// The better of the first two hypotheses. All constants are estimated only if the robot as
/// described with one effect has an open stage. More effects are added to it only if the constants
/// are not sufficient.
AsBuilt best_of_two(const Problem& problem, AsDescribed& described) {
  described.find_first();
  if (described.explains()) return described.answer();
  WithTolerances tolerant(problem);
  if (tolerant.is_sufficient()) return tolerant.answer(described.hints);
  described.find_others();
  AsBuilt first = described.answer();
  if (!first.has_open_stage) return first;
  AsBuilt second = tolerant.answer(described.hints);
  return model_cost(second) < model_cost(first) ? second : first;
}

/// The better of the first two hypotheses, or the unknown law if that answer has several causes,
/// estimated constants and less evidence.
AsBuilt best_of_three(const Problem& problem) {
  constexpr std::size_t few_causes = 2;  // chosen
  AsDescribed described(problem);
  AsBuilt best = best_of_two(problem, described);
  const auto& unknown = described.unknown_law;
  const std::size_t causes = best.beyond_tolerance.size() + best.estimate.point.effects.size();
  const bool is_unknown = unknown && !best.exact && !best.has_open_stage && causes > few_causes &&
                          model_cost(*unknown) < model_cost(best);
  return is_unknown ? *unknown : best;
}

}  // namespace

double determined(const AsBuilt& built, std::size_t constant) {
  return std::max(0.0, 1 - std::pow(built.estimate.sigma(constant), 2));
}

AsBuilt calibrated(const erp::Robot& nominal, std::span<const residuals::Episode> train,
                   const EstimateOptions& options) {
  const Estimator estimator(nominal, train, options);
  AsBuilt built{.uncertain = uncertain_of(nominal, {}, false)};
  built.estimate = estimator.run(built.uncertain, {});
  complete_far_off(estimator, built);
  built.robot = robot_at(built.uncertain, built.estimate.point);
  return built;
}

SizedEffect estimated(const erp::Robot& nominal, std::span<const residuals::Episode> train,
                      const effects::Placed& effect, const EstimateOptions& options) {
  const Estimator estimator(nominal, train, options);
  return sized_effects(estimator.run(uncertain_of(nominal, {}, true), {{}, {effect}})).front();
}

AsBuilt as_built(const erp::Robot& nominal, std::span<const residuals::Episode> train,
                 std::span<const residuals::Episode> held_out, const AsBuiltOptions& options) {
  const Estimator estimator(nominal, train, options.estimate);
  const ResidualVector held_out_residuals(nominal, held_out, options.estimate.seed,
                                          options.estimate.threads);
  AsBuilt built = best_of_three({nominal, estimator, held_out_residuals, options});
  built.robot = robot_at(built.uncertain, built.estimate.point);
  return built;
}

}  // namespace sim::estimation
