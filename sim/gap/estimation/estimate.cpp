#include "sim/gap/estimation/estimate.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

#include "sim/gap/estimation/profile_likelihood.hpp"

namespace sim::estimation {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Sparse = Eigen::SparseMatrix<double>;

/// Options of the numerical derivatives.
struct Differences {
  int threads;
  const Pool* pool = nullptr;
  const Sparse* reused = nullptr;  ///< reused derivatives with respect to the constants, or null
  double stretch = 1;              ///< factor of the steps
};

/// Columns of ∂z/∂unknown from `first` on by forward differences. Each column is a list of row and
/// slope of its entries.
std::vector<Pool::Numbers> columns(const ResidualVector& residuals, const Unknowns& at,
                                   const Estimate& estimate, std::size_t first,
                                   const Differences& d) {
  const residuals::Stages stages(at.robot());
  return map(d.pool, d.threads, at.count() - first, [&](std::size_t n) {
    const std::size_t k = first + n;
    const Unknowns other = at.with(k, at.value(k) + at.step(k, d.stretch));
    const VectorXd change = tiny_change(
        residuals.z(residuals.explain(other.robot(), estimate.explained, at.reach(k, stages))),
        estimate.z);
    Pool::Numbers entries;
    for (Index row = 0; row < change.size(); ++row)
      if (change[row] != 0)
        entries.insert(entries.end(), {double(row), change[row] / (other.value(k) - at.value(k))});
    return entries;
  });
}

Sparse jacobian(const ResidualVector& residuals, const Unknowns& at, const Estimate& estimate,
                const Differences& d) {
  const std::size_t first = d.reused ? at.constants() : 0;
  std::vector<Eigen::Triplet<double>> entries;
  for (Index k = 0; k < Index(first); ++k)
    for (Sparse::InnerIterator i(*d.reused, k); i; ++i)
      entries.emplace_back(int(i.row()), int(k), i.value());
  const auto all = columns(residuals, at, estimate, first, d);
  for (std::size_t n = 0; n < all.size(); ++n)
    for (std::size_t i = 0; i < all[n].size(); i += 2)
      entries.emplace_back(int(all[n][i]), int(first + n), all[n][i + 1]);
  Sparse j(estimate.z.size(), Index(at.count()));
  j.setFromTriplets(entries.begin(), entries.end());
  return j;
}

/// Sets weights w_s and mean squares from the remaining residuals. `exponent`: of c_s; below 1, a
/// stage far from noise has more weight.
void set_weights(const ResidualVector& residuals, Estimate& e, double exponent = 1) {
  constexpr double law_weight = 0.25;  // of a window, because the laws are approximations; chosen
  std::vector<double> square(residuals.stages()), count(square), correlation(square);
  for (const Block& b : residuals.blocks()) {
    const std::span<const double> z(e.z.data() + b.first, std::size_t(b.count));
    const auto judged = double(z.size()) - double(std::ranges::count(z, 0.0));
    if (judged < 2) continue;
    square[b.stage] += e.z.segment(b.first, b.count).squaredNorm(), count[b.stage] += judged;
    correlation[b.stage] += judged * correlation_length(z);
  }
  e.mean_square.assign(square.size(), 0);
  std::vector<double> weight(square.size(), 1);
  for (std::size_t s = 0; s < square.size(); ++s) {
    if (count[s] == 0) continue;
    e.mean_square[s] = square[s] / count[s];
    weight[s] = law_weight /
                (std::pow(std::max(1.0, e.mean_square[s]), exponent) * (correlation[s] / count[s]));
  }
  e.weight.resize(e.z.size());
  for (const Block& b : residuals.blocks())
    e.weight.segment(b.first, b.count).setConstant(weight[b.stage]);
}

struct Normal {
  MatrixXd hessian;
  VectorXd gradient;
};

Normal normal_equations(const Estimate& e, const Unknowns& at) {
  Normal n{MatrixXd(e.jacobian.transpose() * (e.weight.asDiagonal() * e.jacobian)),
           e.jacobian.transpose() * e.weight.cwiseProduct(e.z)};
  for (std::size_t k = 0; k < at.constants(); ++k) {
    const double precision = prior_precision(at.uncertain(), at.point(), k);
    n.hessian(Index(k), Index(k)) += precision;
    n.gradient[Index(k)] += precision * at.value(k);
  }
  for (std::size_t k = at.constants(); k < at.count(); ++k) {
    double& diagonal = n.hessian(Index(k), Index(k));
    diagonal += at.is_logarithm(k) ? 1 : 1e-9 * diagonal + 1e-12;  // z may not depend on k
  }
  return n;
}

MatrixXd inverse(const MatrixXd& hessian) {
  return hessian.ldlt().solve(MatrixXd::Identity(hessian.rows(), hessian.cols()));
}

}  // namespace

Estimator::Estimator(const erp::Robot& nominal, std::span<const residuals::Episode> episodes,
                     const EstimateOptions& options)
    : residuals_(nominal, episodes, options.seed, options.threads), options_(options) {}

namespace {

double cost_of(const Unknowns& at, const VectorXd& z, const VectorXd& weight) {
  return weight.dot(z.cwiseAbs2()) + prior_cost(at.uncertain(), at.point());
}

/// Result of a Levenberg-Marquardt step.
struct Step {
  bool is_better = false;
  double gained = 0, predicted = 0;  ///< decrease of the cost, and that of the linear model
};

Step step(const ResidualVector& residuals, Unknowns& at, Estimate& e, double& damping,
          int threads) {
  const Normal normal = normal_equations(e, at);
  e.covariance = inverse(normal.hessian);
  e.cost = cost_of(at, e.z, e.weight);
  Step result;
  for (int attempt = 0; attempt < 4 && !result.is_better; ++attempt) {
    MatrixXd damped = normal.hessian;
    damped.diagonal() *= 1 + damping;
    const VectorXd change = -damped.ldlt().solve(normal.gradient);
    const Unknowns next = at.moved(change);
    Explained explained = residuals.explain(next.robot(), threads);
    const VectorXd z = residuals.z(explained);
    const double cost = cost_of(next, z, e.weight);
    result = {cost < e.cost, e.cost - cost,
              -(2 * normal.gradient.dot(change) + change.dot(normal.hessian * change))};
    if (!result.is_better) damping = std::max(1e-6, damping) * 30;
    else at = next, e.z = z, e.explained = std::move(explained), e.cost = cost, damping *= 0.1;
  }
  return result;
}

/// Options and state of the minimization.
struct Descent {
  int iterations, threads;
  const Pool* pool = nullptr;
  int flat_steps = 0;  ///< number of first steps with weights of exponent 0.5
  /// Its weights, and derivatives with respect to the constants, are used in all steps; null: they
  /// are recomputed.
  const Estimate* base = nullptr;
  /// The derivatives were computed at the estimate, or one small step before.
  bool are_current = false;
  bool is_stale = true;  ///< the derivatives must be recomputed
};

/// Whether the residual of a stage is far above its noise.
bool is_far_from_noise(const Estimate& e) {
  constexpr double far_square = 3;  // chosen
  return std::ranges::any_of(e.mean_square, [](double square) { return square > far_square; });
}

/// Makes steps until the cost no longer falls. If the residual is then still far above its noise,
/// derivatives are computed over wide steps, which average over the kinks of play and friction.
/// Derivatives are recomputed if a step gained much less than predicted (chord method: Kelley,
/// Iterative Methods for Linear and Nonlinear Equations, 1995, ch. 5).
void descend(const ResidualVector& residuals, Unknowns& at, Estimate& e, Descent& d) {
  constexpr double smallest_gain = 1e-4;  // of a step, relative to the cost; chosen
  constexpr double valid_gain = 0.6;      // gain / predicted gain of valid derivatives; chosen
  constexpr double wide = 1000;           // factor of wide steps; chosen
  int wide_steps = 4;                     // largest number of wide steps; chosen
  double damping = 0, stretch = 1;
  for (int iteration = 0; iteration < d.iterations; ++iteration) {
    const bool is_flat = iteration < d.flat_steps;
    const bool was_wide = stretch != 1;
    if (!d.base) set_weights(residuals, e, is_flat ? 0.5 : 1);
    if (d.is_stale) {
      const Sparse* reused = d.base ? &d.base->jacobian : nullptr;
      e.jacobian = jacobian(residuals, at, e, {d.threads, d.pool, reused, stretch});
      d.are_current = true;
    }
    const Step taken = step(residuals, at, e, damping, d.threads);
    const bool done = !taken.is_better || taken.gained < smallest_gain * e.cost;
    const bool were_current = d.are_current;
    if ((taken.is_better && !done) || was_wide) d.are_current = false;
    d.is_stale = done || was_wide || taken.gained < valid_gain * taken.predicted;
    stretch = 1;
    if (!were_current) continue;
    if (done && is_flat) {
      iteration = d.flat_steps - 1, d.is_stale = false;
    } else if (!is_flat && !d.base && !was_wide && wide_steps > 0 && (done || damping > 1) &&
               is_far_from_noise(e)) {
      --wide_steps, stretch = wide, damping = 0, d.is_stale = true;
    } else if (done) {
      break;
    }
  }
  e.point = at.point();
  e.bound.clear();
  for (std::size_t k = 0; k < at.count(); ++k) e.bound.push_back(at.at_bound(k));
}

/// Minimizes the cost, then sets weights, derivatives and covariance at the minimum.
Estimate minimized(const ResidualVector& residuals, Unknowns at, Estimate e, Descent d) {
  descend(residuals, at, e, d);
  set_weights(residuals, e);
  if (!d.are_current) e.jacobian = jacobian(residuals, at, e, {d.threads, d.pool});
  const Normal normal = normal_equations(e, at);
  e.gradient = normal.gradient, e.covariance = inverse(normal.hessian);
  e.cost = cost_of(at, e.z, e.weight);
  set_profile_variances(residuals, at, e);
  return e;
}

}  // namespace

Estimate Estimator::run(const Uncertain& uncertain, Point start) const {
  constexpr int flat_steps = 3;  // chosen
  const Unknowns at(uncertain, std::move(start));
  Estimate e;
  e.explained = residuals_.explain(at.robot(), options_.threads);
  e.z = residuals_.z(e.explained);
  return minimized(residuals_, at, std::move(e),
                   {options_.iterations, options_.threads, options_.pool, flat_steps});
}

Estimate Estimator::continued(const Uncertain& uncertain, Estimate base) const {
  const Unknowns at(uncertain, base.point);
  Descent descent{options_.iterations, options_.threads, options_.pool};
  descent.is_stale = false;
  return minimized(residuals_, at, std::move(base), descent);
}

Estimate Estimator::candidate(const Uncertain& uncertain, const Estimate& base, Point start,
                              int iterations) const {
  Unknowns at(uncertain, std::move(start));
  Estimate e;
  e.explained = residuals_.explain(at.robot(), 1);
  e.z = residuals_.z(e.explained), e.weight = base.weight;
  Descent descent{iterations, 1, nullptr, 0, &base};
  descend(residuals_, at, e, descent);
  const VectorXd weight = e.weight;
  set_weights(residuals_, e);
  e.weight = weight;
  return e;
}

}  // namespace sim::estimation
