#include "sim/gap/estimation/screen.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <tuple>

#include "sim/gap/estimation/initial_guesses.hpp"
#include "sim/gap/estimation/observable.hpp"
#include "sim/gap/estimation/periods.hpp"
#include "sim/gap/estimation/sensitivities.hpp"

namespace sim::estimation {

using effects::Placed;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Bounds of the step of each size.
struct StepBounds {
  std::vector<double> low = {}, high = {};

  bool is_exceeded(const VectorXd& step, Index n) const {
    return step[n] < low[std::size_t(n)] || step[n] > high[std::size_t(n)];
  }
  bool is_exceeded(const VectorXd& step) const {
    for (Index n = 0; n < step.size(); ++n)
      if (is_exceeded(step, n)) return true;
    return false;
  }
};

/// The estimate to which an effect is added.
struct Basis {
  const Estimate& estimate;
  const std::vector<bool>& open;
  RemainingResidual remaining;
  VectorXd last_step;  ///< of the unknowns without the effect
  double cost = 0;     ///< after that step
};

namespace {

/// Whether a change of z affects an open stage. True if no stage is open.
bool affects_open_stage(const ResidualVector& residuals, const MatrixXd& change,
                        const std::vector<bool>& open) {
  constexpr double smallest_fraction = 1e-3;  // of the change; chosen
  if (std::ranges::count(open, true) == 0) return true;
  double of_open = 0;
  for (const Block& b : residuals.blocks())
    if (open[b.stage]) of_open += change.middleRows(b.first, b.count).squaredNorm();
  return of_open > smallest_fraction * smallest_fraction * change.squaredNorm();
}

constexpr double unlimited = std::numeric_limits<double>::infinity();

/// The step of the sizes to the minimum of stepᵀ G step/2 − slopeᵀ step. A size is not changed if
/// the unknowns that are already estimated have the same effect, or if it would leave its bounds.
/// `without_response`: G without the response of the estimated unknowns.
VectorXd step_within(const MatrixXd& g, const MatrixXd& without_response, const VectorXd& slope,
                     const StepBounds& bounds) {
  constexpr double same_effect = 1e-8, ridge = 1e-6;  // relative; chosen
  std::vector<Index> free;
  for (Index n = 0; n < g.rows(); ++n)
    if (g(n, n) > same_effect * without_response(n, n)) free.push_back(n);
  while (!free.empty()) {
    MatrixXd g_free = g(free, free);
    for (Index n = 1; n < g_free.rows(); ++n) g_free(n, n) *= 1 + ridge;
    const VectorXd solved = g_free.ldlt().solve(slope(free));
    VectorXd step = VectorXd::Zero(g.rows());
    step(free) = solved;
    if (std::erase_if(free, [&](Index n) { return bounds.is_exceeded(step, n); }) == 0) return step;
  }
  return VectorXd::Zero(g.rows());
}

}  // namespace

/// Cost by the linear model of `base` after a step of its unknowns (`moved`) and a change of z by
/// an effect (`changed`).
double Screen::cost_at(const Estimate& base, const RemainingResidual& remaining,
                       const VectorXd& changed, const VectorXd& moved) const {
  Point after = base.point;
  for (std::size_t k = 0; k < after.x.size(); ++k) after.x[k] += moved[Index(k)];
  const ResidualVector& residuals = train_.residuals();
  const VectorXd z = base.z + changed + base.jacobian * moved;
  return misfit(remaining_residual(residuals, remaining, z), residuals) +
         prior_cost(uncertain_, after);
}

/// The best of 1, 2, 4 and 8 times a step, and its gain. The quadratic model overweights windows
/// that the cost limits.
std::pair<double, VectorXd> Screen::best_multiple(const Basis& basis, const Sensitivities& all,
                                                  const MatrixXd& shared, const VectorXd& step,
                                                  const StepBounds& bounds) const {
  constexpr int doublings = 3;  // chosen
  std::pair best{0.0, step};
  for (int n = 0; n <= doublings; ++n) {
    const VectorXd by = std::exp2(n) * step;
    if (n > 0 && bounds.is_exceeded(by)) break;
    const double gain = basis.cost - cost_at(basis.estimate, basis.remaining, all.d * by,
                                             basis.last_step - shared * by);
    if (n > 0 && !(gain > best.first)) break;
    best = {gain, by};
  }
  return best;
}

/// For one shape, the values with the highest score, and the score.
Candidate Screen::score(const Basis& basis, const Sensitivities& all) const {
  const Estimate& base = basis.estimate;
  const MatrixXd wd = base.weight.asDiagonal() * all.d;
  const MatrixXd shared = base.covariance * (base.jacobian.transpose() * wd);
  MatrixXd g = all.d.transpose() * wd;
  const MatrixXd without_response = g;
  g -= wd.transpose() * base.jacobian * shared;
  Candidate candidate{all.shape, 0};
  const auto values = effects::parameters(candidate.start.effect);
  StepBounds bounds;
  bool has_position = false;
  for (std::size_t n = 0; n < all.sizes.size(); ++n) {
    const effects::Parameter& p = values[all.sizes[n]];
    const bool is_size = is_like(p, values[all.sizes[0]]);
    has_position |= !is_size;
    bounds.low.push_back(is_size ? (p.bounds.low - *p.value) / all.perturbation[n] : -unlimited);
    bounds.high.push_back(is_size ? (p.bounds.high - *p.value) / all.perturbation[n] : unlimited);
  }
  VectorXd step = step_within(
      g, without_response, -(wd.transpose() * base.z - shared.transpose() * base.gradient), bounds);
  if (step.isZero(0) || (has_position && step[0] == 0)) return candidate;
  std::tie(candidate.score, step) = best_multiple(basis, all, shared, step, bounds);
  candidate.others = basis.last_step - shared * step;
  for (std::size_t n = 0; n < all.sizes.size(); ++n) {
    const effects::Parameter& p = values[all.sizes[n]];
    const bool is_position = !is_like(p, values[all.sizes[0]]);
    const double by = is_position ? step[Index(n)] / step[0] : step[Index(n)];
    *p.value = std::clamp(*p.value + by * all.perturbation[n], p.bounds.low, p.bounds.high);
  }
  return candidate;
}

/// Score of an initial guess without a step of its values. The unknowns respond linearly.
Candidate Screen::score_guess(const Basis& basis, const Placed& guess,
                              const VectorXd& changed) const {
  const Estimate& base = basis.estimate;
  const VectorXd others = basis.last_step - base.covariance * (base.jacobian.transpose() *
                                                               base.weight.cwiseProduct(changed));
  return {guess, basis.cost - cost_at(base, basis.remaining, changed, others), others};
}

Candidate Screen::best_shape(const Basis& basis, const Placed& neutral) const {
  const Estimate& base = basis.estimate;
  const erp::Robot robot = robot_at(uncertain_, base.point);
  const residuals::Reach reach = residuals::Stages(robot).reach(neutral);
  const ChangedBy z_with = [&](const Placed& placed) -> VectorXd {
    erp::Robot with = robot;
    with.effects.push_back(effects::written(placed));
    return train_.residuals().z(train_.residuals().explain(with, base.explained, reach));
  };
  const ChangedBy changed_by = [&](const Placed& placed) {
    return tiny_change(z_with(placed), base.z);
  };
  Candidate best{neutral, 0};
  std::vector<const residuals::Episode*> recordings;
  for (const residuals::Episode& e : train_.residuals().episodes()) recordings.push_back(&e);
  for (const Placed& guess : initial_guesses(neutral, uncertain_.nominal, recordings)) {
    const VectorXd change = z_with(guess) - base.z;
    if (!affects_open_stage(train_.residuals(), change, basis.open)) continue;
    if (Candidate candidate = score_guess(basis, guess, change); candidate.score > best.score)
      best = std::move(candidate);
  }
  const auto sizes = sizes_of(neutral);
  std::vector<double> by = first_perturbations(neutral, sizes);
  for (const Placed& shape :
       shaped(neutral, periods_of(neutral, robot, train_.residuals(), base))) {
    std::vector<Sensitivities> shapes = secants(shape, sizes, changed_by);
    shapes.push_back(sensitivities(shape, sizes, by, changed_by));
    std::erase_if(shapes, [&](const Sensitivities& all) {
      return !affects_open_stage(train_.residuals(), all.d, basis.open);
    });
    if (shapes.empty()) break;
    for (const Sensitivities& all : shapes)
      if (Candidate candidate = score(basis, all); candidate.score > best.score)
        best = std::move(candidate);
  }
  return best;
}

bool Screen::is_searched(const effects::About& about) const {
  if (about.stage == effects::Stage::bus || about.type.ends_with("_quantisation")) return false;
  if (std::ranges::count(withhold_, about.type)) return false;
  return std::ranges::none_of(uncertain_.constants,
                              [&](const Constant& c) { return about.type == c.effect; });
}

namespace {

/// The score, the value of each parameter, then `others`.
Pool::Numbers numbers_of(Candidate candidate) {
  Pool::Numbers numbers{candidate.score};
  for (const effects::Parameter& p : effects::parameters(candidate.start.effect))
    numbers.push_back(*p.value);
  numbers.insert(numbers.end(), candidate.others.begin(), candidate.others.end());
  return numbers;
}

Candidate candidate_of(Placed effect, const Pool::Numbers& numbers) {
  const auto parameters = effects::parameters(effect.effect);
  for (std::size_t n = 0; n < parameters.size(); ++n) *parameters[n].value = numbers[n + 1];
  const std::size_t before = parameters.size() + 1;
  return {std::move(effect), numbers[0],
          VectorXd::Map(numbers.data() + before, Index(numbers.size() - before))};
}

}  // namespace

std::vector<Candidate> Screen::candidates(const Estimate& base,
                                          const std::vector<bool>& open) const {
  Basis basis{base, open, remaining_residual(train_.residuals(), base.explained, base.z),
              -(base.covariance * base.gradient)};
  basis.cost = cost_at(base, basis.remaining, VectorXd::Zero(base.z.size()), basis.last_step);
  std::vector<Placed> all;
  for (const effects::AnyEffect& effect : effects::library()) {
    const effects::About& about = effects::about(effect);
    if (!is_searched(about)) continue;
    for (const std::string& on : effects::places(uncertain_.nominal, about.seat))
      if (is_observable({on, effect}, uncertain_.nominal, train_.residuals().episodes()) &&
          std::ranges::none_of(base.point.effects, [&](const Placed& p) {
            return p.on == on && p.effect.index() == effect.index();
          }))
        all.push_back({on, effect});
  }
  const EstimateOptions& options = train_.options();
  const auto found = map(options.pool, options.threads, all.size(),
                         [&](std::size_t k) { return numbers_of(best_shape(basis, all[k])); });
  std::vector<Candidate> screened;
  for (std::size_t k = 0; k < all.size(); ++k) screened.push_back(candidate_of(all[k], found[k]));
  std::erase_if(screened, [](const Candidate& c) { return !(c.score > 0); });
  std::ranges::stable_sort(screened, std::greater(), &Candidate::score);
  return screened;
}

}  // namespace sim::estimation
