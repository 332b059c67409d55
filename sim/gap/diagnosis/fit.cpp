#include "sim/gap/diagnosis/fit.hpp"

#include <ceres/ceres.h>

#include <Eigen/Sparse>

#include <algorithm>
#include <cmath>
#include <deque>
#include <functional>
#include <limits>

#include "sim/gap/diagnosis/initial_guesses.hpp"
#include "sim/gap/diagnosis/standard_errors.hpp"

namespace sim::diagnosis {
namespace {

/// A parameter in the coordinate of the optimizer, u = 1 + value/scale. Ceres makes steps relative
/// to u; near u = 1 they are relative to the scale.
struct ScaledParameter {
  double* value;
  effects::Bounds bounds;
  double scale;

  double to_u(double v) const { return 1 + v / scale; }
  double to_value(double u) const { return std::clamp((u - 1) * scale, bounds.low, bounds.high); }
};

std::vector<ScaledParameter> scaled_parameters(effects::AnyEffect& effect) {
  std::vector<ScaledParameter> scaled;
  for (const effects::Parameter& p : effects::parameters(effect))
    if (p.fitted)
      scaled.push_back({p.value, p.bounds, std::max(std::abs(p.bounds.low), p.bounds.high)});
  return scaled;
}

using Effects = std::vector<effects::Placed>;

/// Cache of the last residual vectors. Ceres requests each repeatedly: in its line search, for the
/// cost of the step, and for the derivatives.
class Cache {
 public:
  using Vector = std::vector<double>;

  const Vector* find(const Vector& u) const {
    const auto entry = std::ranges::find(all_, u, &std::pair<Vector, Vector>::first);
    return entry == all_.end() ? nullptr : &entry->second;
  }
  const Vector& store(Vector u, Vector z) {
    const std::size_t capacity = 2 * (u.size() + 1);  // two steps with their derivatives
    if (all_.size() == capacity) all_.pop_front();
    return all_.emplace_back(std::move(u), std::move(z)).second;
  }

 private:
  std::deque<std::pair<Vector, Vector>> all_;
};

/// Residual vector z of an evaluation as a cost for Ceres.
struct Cost {
  std::function<Evaluation(const Effects&)> evaluate;
  const Evaluator& evaluator;
  std::span<const std::size_t> episodes;
  Effects& effects;
  std::vector<ScaledParameter>& scaled;
  std::size_t residuals;
  mutable Cache cache = {};

  bool operator()(double const* const* at, double* z) const {
    const std::vector<double> u(at[0], at[0] + scaled.size());
    const std::vector<double>* cached = cache.find(u);
    std::ranges::copy(cached ? *cached : cache.store(u, z_at(u)), z);
    return true;
  }

 private:
  std::vector<double> z_at(const std::vector<double>& u) const {
    for (std::size_t k = 0; k < scaled.size(); ++k) *scaled[k].value = scaled[k].to_value(u[k]);
    const Evaluation evaluation = evaluate(effects);
    std::vector<double> z;
    for (const std::size_t e : episodes)
      for (const double one : evaluator.whitened(evaluation, e))
        z.push_back(std::isnan(one) ? 0 : one);
    return z;
  }
};

struct Minimum {
  double square;
  std::vector<double> u, sigma;
};

Eigen::MatrixXd dense(const ceres::CRSMatrix& j) {
  using Sparse = Eigen::SparseMatrix<double, Eigen::RowMajor>;
  return Eigen::Map<const Sparse>(j.num_rows, j.num_cols, Eigen::Index(j.values.size()),
                                  j.rows.data(), j.cols.data(), j.values.data());
}

/// Minimizes Σ z² from u. sigma: in the units of the parameters.
Minimum minimize(const Cost& cost_function, std::vector<double> u, int iterations) {
  constexpr double step = 2e-4;  // chosen: of the scale
  ceres::NumericDiffOptions differences;
  differences.relative_step_size = step;
  auto* cost = new ceres::DynamicNumericDiffCostFunction<Cost, ceres::FORWARD>(
      new Cost(cost_function), ceres::TAKE_OWNERSHIP, differences);
  const int count = static_cast<int>(u.size());
  cost->AddParameterBlock(count);
  cost->SetNumResiduals(static_cast<int>(cost_function.residuals));
  ceres::Problem problem;
  problem.AddResidualBlock(cost, nullptr, u.data());
  for (int k = 0; k < count; ++k) {
    const ScaledParameter& one = cost_function.scaled[static_cast<std::size_t>(k)];
    problem.SetParameterLowerBound(u.data(), k, one.to_u(one.bounds.low));
    problem.SetParameterUpperBound(u.data(), k, one.to_u(one.bounds.high) - 2 * step);
  }
  ceres::Solver::Options options;
  options.max_num_iterations = iterations;
  options.linear_solver_type = ceres::DENSE_QR;
  options.function_tolerance = 1e-5;
  options.parameter_tolerance = 1e-6;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);

  ceres::CRSMatrix sparse;
  std::vector<double> z;
  problem.Evaluate({}, nullptr, &z, nullptr, &sparse);
  Minimum minimum{
      2 * summary.final_cost, u,
      standard_errors(dense(sparse), Eigen::VectorXd::Map(z.data(), Eigen::Index(z.size())))};
  for (std::size_t k = 0; k < u.size(); ++k) minimum.sigma[k] *= cost_function.scaled[k].scale;
  return minimum;
}

/// Start points: the values of the parameters (perturbed if they are neutral), then with the second
/// parameter at fractions of its bounds.
std::vector<std::vector<double>> starts(const std::vector<ScaledParameter>& scaled, bool has_values,
                                        const FitOptions& options) {
  constexpr double perturbation = 2e-3;  // of the bounds, off the kink of a law at neutral
  std::vector<std::vector<double>> all;
  std::vector<double> first;
  for (const ScaledParameter& one : scaled) first.push_back(one.to_u(*one.value));
  if (!has_values) first[0] += scaled[0].bounds.high > 0 ? perturbation : -perturbation;
  all.push_back(first);
  if (has_values) return all;
  if (scaled.size() > 1 && scaled[1].bounds.low > 0)
    for (const double fraction : options.shape_starts) {
      const auto& [low, high] = scaled[1].bounds;
      all.push_back(first);
      all.back()[1] = scaled[1].to_u(low * std::pow(high / low, fraction));
    }
  return all;
}

std::vector<double> values_of(effects::Placed placed) {
  std::vector<double> values;
  for (const effects::Parameter& p : effects::parameters(placed.effect)) values.push_back(*p.value);
  return values;
}

/// Evaluates several effects. If only one effect differs from the last full evaluation, as in
/// numerical derivatives, only the parts that it changes are recomputed.
class IncrementalEvaluation {
 public:
  IncrementalEvaluation(const Evaluator& evaluator, std::span<const std::size_t> episodes)
      : evaluator_(evaluator), episodes_(episodes) {}

  Evaluation operator()(const Effects& effects) {
    std::vector<std::size_t> changed;
    for (std::size_t k = 0; k < base_.effects.size(); ++k)
      if (values_of(effects[k]) != values_of(base_.effects[k])) changed.push_back(k);
    if (changed.size() == 1)
      return evaluator_.changed(base_, changed[0], effects[changed[0]], episodes_);
    if (base_.effects.empty() || !changed.empty()) base_ = evaluator_.with(effects, episodes_);
    return base_;
  }

 private:
  const Evaluator& evaluator_;
  std::span<const std::size_t> episodes_;
  Evaluation base_;
};

std::size_t count_residuals(const Evaluator& evaluator, std::span<const std::size_t> episodes) {
  std::size_t count = 0;
  for (const std::size_t e : episodes)
    count += evaluator.whitened(evaluator.nominal_evaluation(), e).size();
  return count;
}

Fit result_of(const effects::Placed& placed, double square, std::span<const double> sigmas) {
  Fit fit{placed, square, {}, {sigmas.begin(), sigmas.end()}};
  for (const ScaledParameter& one : scaled_parameters(fit.placed.effect))
    fit.values.push_back(*one.value);
  return fit;
}

}  // namespace

bool is_at_bound(const effects::Parameter& neutral, double value) {
  const auto [low, high] = neutral.bounds;
  const double rounding = 1e-6 * (high - low);
  return (value <= low + rounding && low != *neutral.value) ||
         (value >= high - rounding && high != *neutral.value);
}

bool has_size_at_bound(const effects::Placed& placed) {
  effects::AnyEffect effect = placed.effect;
  effects::AnyEffect neutral = *effects::neutral(effects::about(effect).type);
  return is_at_bound(effects::parameters(neutral)[0], *effects::parameters(effect)[0].value);
}

Fit fit(const Evaluator& evaluator, const Evaluation& base, const effects::Placed& added,
        std::span<const std::size_t> episodes, const FitOptions& options) {
  Effects effects{best_initial_guess(evaluator, base, added, episodes)};
  std::vector<ScaledParameter> scaled = scaled_parameters(effects[0].effect);
  const Cost cost{[&](const Effects& e) { return evaluator.with(base, e[0], episodes); },
                  evaluator,
                  episodes,
                  effects,
                  scaled,
                  count_residuals(evaluator, episodes)};
  Minimum best{};
  for (const auto& start : starts(scaled, !is_neutral(effects[0]), options))
    if (Minimum minimum = minimize(cost, start, options.iterations);
        best.u.empty() || minimum.square < best.square)
      best = std::move(minimum);
  for (std::size_t k = 0; k < scaled.size(); ++k) *scaled[k].value = scaled[k].to_value(best.u[k]);
  return result_of(effects[0], best.square, best.sigma);
}

std::vector<Fit> fit_jointly(const Evaluator& evaluator, std::span<const effects::Placed> all,
                             std::span<const std::size_t> episodes, const FitOptions& options) {
  Effects effects(all.begin(), all.end());
  std::vector<ScaledParameter> scaled;
  std::vector<std::size_t> first;
  for (effects::Placed& placed : effects) {
    first.push_back(scaled.size());
    for (const ScaledParameter& one : scaled_parameters(placed.effect)) scaled.push_back(one);
  }
  first.push_back(scaled.size());
  IncrementalEvaluation evaluate(evaluator, episodes);
  const Cost cost{std::ref(evaluate),
                  evaluator,
                  episodes,
                  effects,
                  scaled,
                  count_residuals(evaluator, episodes)};
  std::vector<double> u;
  for (const ScaledParameter& one : scaled) u.push_back(one.to_u(*one.value));
  const Minimum minimum = minimize(cost, u, options.iterations);
  for (std::size_t k = 0; k < scaled.size(); ++k)
    *scaled[k].value = scaled[k].to_value(minimum.u[k]);
  std::vector<Fit> fits;
  for (std::size_t n = 0; n < effects.size(); ++n)
    fits.push_back(result_of(effects[n], minimum.square,
                             std::span(minimum.sigma).subspan(first[n], first[n + 1] - first[n])));
  return fits;
}

}  // namespace sim::diagnosis
