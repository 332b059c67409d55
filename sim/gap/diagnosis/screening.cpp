#include "sim/gap/diagnosis/screening.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "sim/gap/diagnosis/initial_guesses.hpp"
#include "sim/gap/estimation/observable.hpp"
#include "sim/gap/residuals/indices.hpp"

namespace sim::diagnosis {
namespace {

using effects::Placed;
using Eigen::VectorXd;

/// Screens candidates on some recordings; z is 0 in windows that are not evaluated.
class Screen {
 public:
  Screen(const Evaluator& evaluator, const Evaluation& base, std::vector<std::size_t> episodes)
      : evaluator_(evaluator), base_(base), episodes_(std::move(episodes)), residual_(z_of(base)) {
    for (std::size_t e = 0; e < base.effects.size(); ++e) add_sensitivities(e);
  }

  /// Best score over the candidate's parameters and initial guesses; 0 if it changes no residual.
  double screening_score(const Placed& neutral) const {
    double best = 0;
    for (const Placed& perturbed : perturbations(neutral))
      best =
          std::max(best, score_of(z_of(evaluator_.with(base_, perturbed, episodes_)) - residual_));
    for (const Placed& one : initial_guesses(evaluator_, neutral, episodes_))
      best = std::max(best, residual_.squaredNorm() -
                                z_of(evaluator_.with(base_, one, episodes_)).squaredNorm());
    return best;
  }

 private:
  VectorXd z_of(const Evaluation& evaluation) const {
    std::vector<double> all;
    for (const std::size_t e : episodes_)
      for (const double z : evaluator_.whitened(evaluation, e))
        all.push_back(std::isnan(z) ? 0 : z);
    return VectorXd::Map(all.data(), Eigen::Index(all.size()));
  }

  /// (zᵀ d⊥)²/(d⊥ᵀ d⊥)
  double score_of(VectorXd change) const {
    const double total = change.squaredNorm();
    for (const VectorXd& d : sensitivities_) change -= d.dot(change) * d;
    const double square = change.squaredNorm();
    // Of its square; less is reproduced by the present effects.
    constexpr double smallest_part = 1e-4;
    if (square < 1e-12 || square < smallest_part * total) return 0;
    return std::pow(residual_.dot(change), 2) / square;
  }

  /// Adds the changes by the parameters of an effect of the base, orthonormal to the others.
  void add_sensitivities(std::size_t e) {
    effects::AnyEffect counted = base_.effects[e].effect;
    const std::size_t count = effects::parameters(counted).size();
    for (std::size_t k = 0; k < count; ++k) {
      auto all = base_.effects;
      const auto parameter = effects::parameters(all[e].effect)[k];
      if (!parameter.fitted) continue;
      const double step = 1e-3 * (parameter.bounds.high - parameter.bounds.low);
      *parameter.value += *parameter.value + step > parameter.bounds.high ? -step : step;
      VectorXd d = z_of(evaluator_.with(all, episodes_)) - residual_;
      for (const VectorXd& other : sensitivities_) d -= other.dot(d) * other;
      if (d.norm() > 1e-9) sensitivities_.push_back(d.normalized());
    }
  }

  const Evaluator& evaluator_;
  const Evaluation& base_;
  std::vector<std::size_t> episodes_;
  VectorXd residual_;
  std::vector<VectorXd> sensitivities_;
};

std::vector<double> screening_scores(const Evaluator& evaluator, const Evaluation& base,
                                     const RankingOptions& options,
                                     const std::vector<Placed>& all) {
  std::vector<double> scores(all.size());
  // All recordings of a drive are used because each may have a single speed.
  const bool is_drive = !evaluator.nominal().drives.empty();
  const Screen screen(
      evaluator, base,
      is_drive ? options.train : std::vector{largest_residuals_in(evaluator, base, options.train)});
  const auto results = map(options.pool, options.threads, all.size(), [&](std::size_t k) {
    return Pool::Numbers{screen.screening_score(all[k])};
  });
  for (std::size_t k = 0; k < all.size(); ++k) scores[k] = results[k][0];
  return scores;
}

}  // namespace

std::vector<Placed> candidates(const Evaluator& evaluator,
                               const std::vector<std::string>& withhold) {
  const bool estimated =
      std::ranges::any_of(evaluator.nominal_evaluation().of_episode,
                          [](const residuals::Explanation& e) { return e.joints->estimated; });
  const residuals::Stages nominal(evaluator.nominal());
  std::vector<Placed> all;
  for (const effects::AnyEffect& effect : effects::library()) {
    const effects::About& about = effects::about(effect);
    if (std::ranges::count(withhold, about.type)) continue;
    for (const std::string& on : effects::places(evaluator.nominal(), about.seat))
      if (const Placed placed{on, effect};
          estimation::is_observable(placed, evaluator.nominal(), evaluator.episodes()) &&
          !(estimated && nominal.reach(placed).joints))
        all.push_back(placed);
  }
  return all;
}

std::vector<Placed> perturbations(const Placed& neutral) {
  constexpr double small = 3e-3;
  std::vector<Placed> all;
  effects::AnyEffect counted = neutral.effect;
  const std::size_t count = effects::parameters(counted).size();
  for (std::size_t k = 0; k < count; ++k)
    for (const double fraction : {small, 0.1}) {
      Placed perturbed = neutral;
      const auto parameters = effects::parameters(perturbed.effect);
      if (!parameters[k].fitted) continue;
      for (std::size_t other = 0; other < k; ++other)
        *parameters[other].value += small * parameters[other].bounds.high;
      const auto& [low, high] = parameters[k].bounds;
      *parameters[k].value += fraction * (high > 0 ? high : low);
      all.push_back(std::move(perturbed));
    }
  return all;
}

std::size_t largest_residuals_in(const Evaluator& evaluator, const Evaluation& base,
                                 std::span<const std::size_t> episodes) {
  return *std::ranges::max_element(episodes, {}, [&](std::size_t e) {
    const std::size_t only[] = {e};
    return sum(evaluator.blocks(base, only)).square;
  });
}

std::vector<Placed> screen_effects(const Evaluator& evaluator, const Evaluation& base,
                                   const RankingOptions& options) {
  const auto all = candidates(evaluator, options.withhold);
  const auto scores = screening_scores(evaluator, base, options, all);
  auto sorted = scores;
  std::ranges::sort(sorted, std::greater());
  const double threshold = std::min(options.screen_share * sorted[0],
                                    sorted[std::min(options.fitted_at_least, sorted.size()) - 1]);
  std::vector<Placed> chosen;
  for (std::size_t k = 0; k < all.size(); ++k)
    if (scores[k] > 0 && scores[k] >= threshold) chosen.push_back(all[k]);
  return chosen;
}

std::vector<Placed> best_screened(const Evaluator& evaluator, const Evaluation& base,
                                  const RankingOptions& options, std::size_t count) {
  const auto all = candidates(evaluator, options.withhold);
  const auto scores = screening_scores(evaluator, base, options, all);
  auto order = each(all.size());
  std::ranges::stable_sort(order, std::greater(), [&](std::size_t k) { return scores[k]; });
  std::vector<Placed> chosen;
  for (std::size_t k = 0; k < std::min(count, all.size()) && scores[order[k]] > 0; ++k)
    chosen.push_back(all[order[k]]);
  return chosen;
}

}  // namespace sim::diagnosis
