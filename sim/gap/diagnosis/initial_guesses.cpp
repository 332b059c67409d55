#include "sim/gap/diagnosis/initial_guesses.hpp"

#include <algorithm>
#include <cmath>

#include "sim/gap/estimation/initial_guesses.hpp"

namespace sim::diagnosis {
namespace {

/// Number of parameters that are not neutral.
std::size_t changed_parameters(const effects::Placed& placed) {
  return effects::written(placed).parameters.size();
}

}  // namespace

bool is_neutral(const effects::Placed& placed) { return changed_parameters(placed) == 0; }

std::vector<effects::Placed> initial_guesses(const Evaluator& evaluator,
                                             const effects::Placed& neutral,
                                             std::span<const std::size_t> episodes) {
  const auto type = effects::about(neutral.effect).type;
  std::vector<const residuals::Episode*> recordings;
  for (const std::size_t e : episodes) recordings.push_back(&evaluator.episodes()[e]);
  auto all = estimation::initial_guesses(neutral, evaluator.nominal(), recordings);
  constexpr double soft = 0.7, stiff = 0.01;  // rad/Nm; chosen
  constexpr double ratio = 0.8;               // of successive guesses; chosen
  if (type == "skeleton_link_flexibility")
    for (double c = soft; c > stiff; c *= ratio) {
      all.push_back(neutral);
      *effects::parameters(all.back().effect)[0].value = c;
    }
  return all;
}

effects::Placed best_initial_guess(const Evaluator& evaluator, const Evaluation& base,
                                   const effects::Placed& effect,
                                   std::span<const std::size_t> episodes) {
  constexpr double parameter_price = 0.01;  // of each after the first, relative to the gap; chosen
  effects::Placed best = effect;
  if (!is_neutral(effect)) return best;
  const ScoreBlock total = sum(evaluator.blocks(base, episodes));
  const double before = total.square,
               gap = std::max(0.0, before - static_cast<double>(total.windows));
  auto all = initial_guesses(evaluator, effect, episodes);
  // Fractions of the bounds, for laws that are nonlinear at their neutral value; chosen.
  for (const double fraction : {0.1, 0.02, -0.1}) {
    all.push_back(effect);
    const effects::Parameter first = effects::parameters(all.back().effect)[0];
    *first.value = fraction * (fraction > 0 ? first.bounds.high : -first.bounds.low);
    if (*first.value == 0) all.pop_back();
  }
  const auto cost = [&](const effects::Placed& one) {
    const std::size_t extra = std::max<std::size_t>(1, changed_parameters(one)) - 1;
    return sum(evaluator.blocks(evaluator.with(base, one, episodes), episodes)).square +
           parameter_price * gap * static_cast<double>(extra);
  };
  double smallest_cost = before;
  for (const effects::Placed& one : all)
    if (const double guess_cost = cost(one); guess_cost < smallest_cost)
      smallest_cost = guess_cost, best = one;
  return best;
}

}  // namespace sim::diagnosis
