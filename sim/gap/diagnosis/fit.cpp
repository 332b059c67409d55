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

/// A parameter as the optimiser sees it: u = 1 + value/scale, so that a step relative to u is one
/// relative to the scale.
struct Knob {
  double* value;
  effects::Bounds bounds;
  double scale;

  double to_u(double v) const { return 1 + v / scale; }
  double to_value(double u) const { return std::clamp((u - 1) * scale, bounds.low, bounds.high); }
};

std::vector<Knob> knobs_of(effects::AnyEffect& effect) {
  std::vector<Knob> knobs;
  for (const effects::Parameter& p : effects::parameters(effect))
    if (p.fitted)
      knobs.push_back({p.value, p.bounds, std::max(std::abs(p.bounds.low), p.bounds.high)});
  return knobs;
}

using Effects = std::vector<effects::Placed>;

/// Answers given last. Ceres asks for each again: in its line search, for the cost of the step, and
/// for derivatives there.
class Lately {
 public:
  using Vector = std::vector<double>;

  const Vector* answer(const Vector& u) const {
    const auto found = std::ranges::find(all_, u, &std::pair<Vector, Vector>::first);
    return found == all_.end() ? nullptr : &found->second;
  }
  const Vector& keep(Vector u, Vector z) {
    const std::size_t kept = 2 * (u.size() + 1);  // two steps with their derivatives
    if (all_.size() == kept) all_.pop_front();
    return all_.emplace_back(std::move(u), std::move(z)).second;
  }

 private:
  std::deque<std::pair<Vector, Vector>> all_;
};

/// Σ z² of a trial as a cost for Ceres.
struct Cost {
  std::function<Evaluation(const Effects&)> tried;
  const Evaluator& evaluator;
  std::span<const std::size_t> episodes;
  Effects& effects;
  std::vector<Knob>& knobs;
  std::size_t residuals;
  mutable Lately lately = {};

  bool operator()(double const* const* at, double* z) const {
    const std::vector<double> u(at[0], at[0] + knobs.size());
    const std::vector<double>* known = lately.answer(u);
    std::ranges::copy(known ? *known : lately.keep(u, of(u)), z);
    return true;
  }

 private:
  std::vector<double> of(const std::vector<double>& u) const {
    for (std::size_t k = 0; k < knobs.size(); ++k) *knobs[k].value = knobs[k].to_value(u[k]);
    const Evaluation evaluation = tried(effects);
    std::vector<double> z;
    for (const std::size_t e : episodes)
      for (const double one : evaluator.whitened(evaluation, e))
        z.push_back(std::isnan(one) ? 0 : one);
    return z;
  }
};

struct Least {
  double square;
  std::vector<double> u, sigma;
};

Eigen::MatrixXd dense(const ceres::CRSMatrix& j) {
  using Sparse = Eigen::SparseMatrix<double, Eigen::RowMajor>;
  return Eigen::Map<const Sparse>(j.num_rows, j.num_cols, Eigen::Index(j.values.size()),
                                  j.rows.data(), j.cols.data(), j.values.data());
}

/// From u; sigma in the parameters' units.
Least minimise(const Cost& given, std::vector<double> u, int iterations) {
  constexpr double step = 2e-4;  // chosen: of the scale
  ceres::NumericDiffOptions differences;
  differences.relative_step_size = step;
  auto* cost = new ceres::DynamicNumericDiffCostFunction<Cost, ceres::FORWARD>(
      new Cost(given), ceres::TAKE_OWNERSHIP, differences);
  const int count = static_cast<int>(u.size());
  cost->AddParameterBlock(count);
  cost->SetNumResiduals(static_cast<int>(given.residuals));
  ceres::Problem problem;
  problem.AddResidualBlock(cost, nullptr, u.data());
  for (int k = 0; k < count; ++k) {
    const Knob& knob = given.knobs[static_cast<std::size_t>(k)];
    problem.SetParameterLowerBound(u.data(), k, knob.to_u(knob.bounds.low));
    problem.SetParameterUpperBound(u.data(), k, knob.to_u(knob.bounds.high) - 2 * step);
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
  Least least{
      2 * summary.final_cost, u,
      standard_errors(dense(sparse), Eigen::VectorXd::Map(z.data(), Eigen::Index(z.size())))};
  for (std::size_t k = 0; k < u.size(); ++k) least.sigma[k] *= given.knobs[k].scale;
  return least;
}

/// Where to begin: as given; and, for what shapes the law, at some shares of its bounds.
std::vector<std::vector<double>> starts(const std::vector<Knob>& knobs, bool given,
                                        const FitOptions& options) {
  constexpr double perturbation = 2e-3;  // of the bounds, off a law's kink at its neutral value
  std::vector<std::vector<double>> all;
  std::vector<double> first;
  for (const Knob& knob : knobs) first.push_back(knob.to_u(*knob.value));
  if (!given) first[0] += knobs[0].bounds.high > 0 ? perturbation : -perturbation;
  all.push_back(first);
  if (given) return all;
  if (knobs.size() > 1 && knobs[1].bounds.low > 0)
    for (const double share : options.shape_starts) {
      const auto& [low, high] = knobs[1].bounds;
      all.push_back(first);
      all.back()[1] = knobs[1].to_u(low * std::pow(high / low, share));
    }
  return all;
}

std::vector<double> values_of(effects::Placed placed) {
  std::vector<double> values;
  for (const effects::Parameter& p : effects::parameters(placed.effect)) values.push_back(*p.value);
  return values;
}

/// Several effects at values of which mostly one effect's differ from those before: derivatives
/// change one at a time.
class OneByOne {
 public:
  OneByOne(const Evaluator& evaluator, std::span<const std::size_t> episodes)
      : evaluator_(evaluator), episodes_(episodes) {}

  Evaluation operator()(const Effects& now) {
    std::vector<std::size_t> other;
    for (std::size_t k = 0; k < middle_.effects.size(); ++k)
      if (values_of(now[k]) != values_of(middle_.effects[k])) other.push_back(k);
    if (other.size() == 1) return evaluator_.changed(middle_, other[0], now[other[0]], episodes_);
    if (middle_.effects.empty() || !other.empty()) middle_ = evaluator_.with(now, episodes_);
    return middle_;
  }

 private:
  const Evaluator& evaluator_;
  std::span<const std::size_t> episodes_;
  Evaluation middle_;
};

std::size_t count_residuals(const Evaluator& evaluator, std::span<const std::size_t> episodes) {
  std::size_t count = 0;
  for (const std::size_t e : episodes) count += evaluator.whitened(evaluator.bare(), e).size();
  return count;
}

Fit result_of(const effects::Placed& placed, double square, std::span<const double> sigmas) {
  Fit fit{placed, square, {}, {sigmas.begin(), sigmas.end()}};
  for (const Knob& knob : knobs_of(fit.placed.effect)) fit.values.push_back(*knob.value);
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

Fit fit(const Evaluator& evaluator, const Evaluation& base, const effects::Placed& more,
        std::span<const std::size_t> episodes, const FitOptions& options) {
  Effects effects{best_initial_guess(evaluator, base, more, episodes)};
  std::vector<Knob> knobs = knobs_of(effects[0].effect);
  const Cost cost{[&](const Effects& e) { return evaluator.with(base, e[0], episodes); },
                  evaluator,
                  episodes,
                  effects,
                  knobs,
                  count_residuals(evaluator, episodes)};
  Least best{};
  for (const auto& start : starts(knobs, !is_neutral(effects[0]), options))
    if (Least least = minimise(cost, start, options.iterations);
        best.u.empty() || least.square < best.square)
      best = std::move(least);
  for (std::size_t k = 0; k < knobs.size(); ++k) *knobs[k].value = knobs[k].to_value(best.u[k]);
  return result_of(effects[0], best.square, best.sigma);
}

std::vector<Fit> fit_together(const Evaluator& evaluator, std::span<const effects::Placed> all,
                              std::span<const std::size_t> episodes, const FitOptions& options) {
  Effects effects(all.begin(), all.end());
  std::vector<Knob> knobs;
  std::vector<std::size_t> first;
  for (effects::Placed& placed : effects) {
    first.push_back(knobs.size());
    for (const Knob& knob : knobs_of(placed.effect)) knobs.push_back(knob);
  }
  first.push_back(knobs.size());
  OneByOne tried(evaluator, episodes);
  const Cost cost{std::ref(tried), evaluator, episodes,
                  effects,         knobs,     count_residuals(evaluator, episodes)};
  std::vector<double> u;
  for (const Knob& knob : knobs) u.push_back(knob.to_u(*knob.value));
  const Least least = minimise(cost, u, options.iterations);
  for (std::size_t k = 0; k < knobs.size(); ++k) *knobs[k].value = knobs[k].to_value(least.u[k]);
  std::vector<Fit> fits;
  for (std::size_t n = 0; n < effects.size(); ++n)
    fits.push_back(result_of(effects[n], least.square,
                             std::span(least.sigma).subspan(first[n], first[n + 1] - first[n])));
  return fits;
}

}  // namespace sim::diagnosis
