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
  const Sparse* known = nullptr;  ///< derivatives with respect to the constants that are reused
  double stretch = 1;             ///< factor of the steps
};

/// Columns `from` … of ∂z/∂unknown by forward differences, as a list of row and slope of each entry.
std::vector<Pool::Numbers> columns(const ResidualVector& residuals, const Unknowns& at,
                                   const Estimate& here, std::size_t from, const Differences& d) {
  const residuals::Stages stages(at.robot());
  return map(d.pool, d.threads, at.count() - from, [&](std::size_t n) {
    const std::size_t k = from + n;
    const Unknowns other = at.with(k, at.value(k) + at.step(k, d.stretch));
    const VectorXd change = tiny_change(
        residuals.z(residuals.explain(other.robot(), here.explained, at.reach(k, stages))), here.z);
    Pool::Numbers entries;
    for (Index row = 0; row < change.size(); ++row)
      if (change[row] != 0)
        entries.insert(entries.end(), {double(row), change[row] / (other.value(k) - at.value(k))});
    return entries;
  });
}

Sparse jacobian(const ResidualVector& residuals, const Unknowns& at, const Estimate& here,
                const Differences& d) {
  const std::size_t from = d.known ? at.constants() : 0;
  std::vector<Eigen::Triplet<double>> entries;
  for (Index k = 0; k < Index(from); ++k)
    for (Sparse::InnerIterator i(*d.known, k); i; ++i)
      entries.emplace_back(int(i.row()), int(k), i.value());
  const auto all = columns(residuals, at, here, from, d);
  for (std::size_t n = 0; n < all.size(); ++n)
    for (std::size_t i = 0; i < all[n].size(); i += 2)
      entries.emplace_back(int(all[n][i]), int(from + n), all[n][i + 1]);
  Sparse j(here.z.size(), Index(at.count()));
  j.setFromTriplets(entries.begin(), entries.end());
  return j;
}

/// Sets weights and mean squares from the remaining residuals. `trust`: exponent of c_s; below 1, a stage far from
/// noise has more weight.
void set_weights(const ResidualVector& residuals, Estimate& e, double trust = 1) {
  constexpr double of_laws = 0.25;  // weight of a window, for the laws are approximations; chosen
  std::vector<double> square(residuals.stages()), count(square), correlation(square);
  for (const Block& b : residuals.blocks()) {
    const std::span<const double> here(e.z.data() + b.first, std::size_t(b.count));
    const auto judged = double(here.size()) - double(std::ranges::count(here, 0.0));
    if (judged < 2) continue;
    square[b.stage] += e.z.segment(b.first, b.count).squaredNorm(), count[b.stage] += judged;
    correlation[b.stage] += judged * correlated(here);
  }
  e.mean_square.assign(square.size(), 0);
  std::vector<double> weight(square.size(), 1);
  for (std::size_t s = 0; s < square.size(); ++s) {
    if (count[s] == 0) continue;
    e.mean_square[s] = square[s] / count[s];
    weight[s] =
        of_laws / (std::pow(std::max(1.0, e.mean_square[s]), trust) * (correlation[s] / count[s]));
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
  for (std::size_t k = at.constants(); k < at.count();
       ++k) {  // regularization, for z may not depend on it
    double& own = n.hessian(Index(k), Index(k));
    own += at.is_logarithm(k) ? 1 : 1e-9 * own + 1e-12;
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

/// One Levenberg-Marquardt step, shortened until the cost falls.
struct Step {
  bool better = false;
  double gained = 0, predicted = 0;  ///< decrease of the cost, and that of the linear model
};

Step step(const ResidualVector& residuals, Unknowns& at, Estimate& e, double& damping,
          int threads) {
  const Normal normal = normal_equations(e, at);
  e.covariance = inverse(normal.hessian);
  e.cost = cost_of(at, e.z, e.weight);
  Step taken;
  for (int attempt = 0; attempt < 4 && !taken.better; ++attempt) {
    MatrixXd damped = normal.hessian;
    damped.diagonal() *= 1 + damping;
    const VectorXd by = -damped.ldlt().solve(normal.gradient);
    const Unknowns next = at.moved(by);
    Explained explained = residuals.explain(next.robot(), threads);
    const VectorXd z = residuals.z(explained);
    const double after = cost_of(next, z, e.weight);
    taken = {after < e.cost, e.cost - after,
             -(2 * normal.gradient.dot(by) + by.dot(normal.hessian * by))};
    if (!taken.better) damping = std::max(1e-6, damping) * 30;
    else at = next, e.z = z, e.explained = std::move(explained), e.cost = after, damping *= 0.1;
  }
  return taken;
}

/// Options and state of the minimization.
struct Descent {
  int iterations, threads;
  const Pool* pool = nullptr;
  int far = 0;  ///< number of first steps with weights of trust 0.5
  const Estimate* base =
      nullptr;  ///< its weights and derivatives with respect to the constants are used throughout
  bool fresh =
      false;  ///< whether the derivatives were computed at the estimate, or one small step before
  bool stale = true;  ///< whether they must be recomputed
};

/// Whether a stage keeps much more than noise.
bool is_far_from_noise(const Estimate& e) {
  constexpr double far = 3;  // chosen
  return std::ranges::any_of(e.mean_square, [](double square) { return square > far; });
}

/// Makes steps until one no longer lowers the cost. If much more than noise remains then, derivatives are computed over
/// wide steps, which average over the kinks of play and friction. Derivatives are recomputed if a step gained much less
/// than predicted (chord method: Kelley, Iterative Methods for Linear and Nonlinear Equations, 1995, ch. 5).
void descend(const ResidualVector& residuals, Unknowns& at, Estimate& e, Descent& d) {
  constexpr double enough = 1e-4;  // smallest gain of a step / cost; chosen
  constexpr double kept = 0.6;     // gain / predicted gain of valid derivatives; chosen
  constexpr double wide = 1000;    // factor of wide steps; chosen
  int wides = 4;                   // largest number of wide steps; chosen
  double damping = 0, stretch = 1;
  for (int iteration = 0; iteration < d.iterations; ++iteration) {
    const bool far = iteration < d.far;
    const bool was_wide = stretch != 1;
    if (!d.base) set_weights(residuals, e, far ? 0.5 : 1);
    if (d.stale) {
      const Sparse* known = d.base ? &d.base->jacobian : nullptr;
      e.jacobian = jacobian(residuals, at, e, {d.threads, d.pool, known, stretch});
      d.fresh = true;
    }
    const Step taken = step(residuals, at, e, damping, d.threads);
    const bool done = !taken.better || taken.gained < enough * e.cost;
    const bool was_fresh = d.fresh;
    if ((taken.better && !done) || was_wide) d.fresh = false;
    d.stale = done || was_wide || taken.gained < kept * taken.predicted;
    stretch = 1;
    if (!was_fresh) continue;
    if (done && far) {
      iteration = d.far - 1, d.stale = false;
    } else if (!far && !d.base && !was_wide && wides > 0 && (done || damping > 1) &&
               is_far_from_noise(e)) {
      --wides, stretch = wide, damping = 0, d.stale = true;
    } else if (done) {
      break;
    }
  }
  e.point = at.point();
  e.bound.clear();
  for (std::size_t k = 0; k < at.count(); ++k) e.bound.push_back(at.at_bound(k));
}

/// Minimizes the cost, then sets weights, derivatives and covariance at the minimum.
Estimate settled(const ResidualVector& residuals, Unknowns at, Estimate e, Descent d) {
  descend(residuals, at, e, d);
  set_weights(residuals, e);
  if (!d.fresh) e.jacobian = jacobian(residuals, at, e, {d.threads, d.pool});
  const Normal normal = normal_equations(e, at);
  e.gradient = normal.gradient, e.covariance = inverse(normal.hessian);
  e.cost = cost_of(at, e.z, e.weight);
  set_profile_variances(residuals, at, e);
  return e;
}

}  // namespace

Estimate Estimator::run(const Uncertain& uncertain, Point start) const {
  constexpr int far = 3;  // steps; chosen
  const Unknowns at(uncertain, std::move(start));
  Estimate e;
  e.explained = residuals_.explain(at.robot(), options_.threads);
  e.z = residuals_.z(e.explained);
  return settled(residuals_, at, std::move(e),
                 {options_.iterations, options_.threads, options_.pool, far});
}

Estimate Estimator::continued(const Uncertain& uncertain, Estimate from) const {
  const Unknowns at(uncertain, from.point);
  Descent descent{options_.iterations, options_.threads, options_.pool};
  descent.stale = false;
  return settled(residuals_, at, std::move(from), descent);
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
