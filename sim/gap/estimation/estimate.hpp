#pragma once
#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cmath>

#include "interfaces/parallel/pool.hpp"
#include "sim/gap/estimation/residual_vector.hpp"
#include "sim/gap/estimation/unknowns.hpp"

/// Joint estimate of all constants of a robot and of the parameters of its effects, from the stage
/// residuals of recordings. Maximum a posteriori, by Gauss-Newton steps.
///
///   min over x, p   Σ_s w_s Σ_k z_sk(x, p)² + prior(x)    z: residual_vector.hpp, prior: unknowns.hpp
///   w_s = 1/(4 c_s v_s)    c_s = max(1, ⟨z_s²⟩): an open stage has less weight
///                          v_s = 1 + 2 Σ ρ_l: number of windows per independent window
///                          4: chosen, because the laws are approximations
///
/// x: deviations of constants in tolerances; p: parameters of effects, without a prior, within
/// their bounds. The covariance is the inverse of the Hessian. Source: Gelman et al., Bayesian Data
/// Analysis, ch. 4 and 17.
namespace sim::estimation {

struct EstimateOptions {
  int iterations = 30;
  int threads = 2;
  std::uint64_t seed = 1;
  const Pool* pool = nullptr;  ///< processes for derivatives and screening; null: only `threads`
};

/// A point with its covariance and derivatives.
struct Estimate {
  Point point;
  Explained explained;  ///< the recordings, evaluated with the robot at `point`
  Eigen::VectorXd z, weight;
  Eigen::VectorXd gradient;              ///< of cost/2
  Eigen::SparseMatrix<double> jacobian;  ///< ∂z/∂unknown
  Eigen::MatrixXd covariance;            ///< of x, then of each fitted parameter in its unit
  std::vector<double> mean_square;       ///< ⟨z²⟩ of each stage, in the order of the residuals
  std::vector<bool> bound;  ///< whether each unknown is at a bound; false for constants
  double cost = 0;

  /// Standard deviation of unknown k.
  double sigma(std::size_t k) const {
    return std::sqrt(covariance(Eigen::Index(k), Eigen::Index(k)));
  }
};

class Estimator {
 public:
  /// `nominal` and `episodes` must outlive the estimator. Throws the exceptions of
  /// residuals::Stages.
  Estimator(const erp::Robot& nominal, std::span<const residuals::Episode> episodes,
            const EstimateOptions& options = {});

  const ResidualVector& residuals() const { return residuals_; }
  const EstimateOptions& options() const { return options_; }

  Estimate run(const Uncertain& uncertain, Point start) const;
  /// Estimates from a starting point.
  Estimate continued(const Uncertain& uncertain, Estimate base) const;
  /// Estimates `base` with an additional effect by a few steps on one thread. Weights, and
  /// derivatives with respect to the constants, are those of `base`.
  Estimate candidate(const Uncertain& uncertain, const Estimate& base, Point start,
                     int iterations) const;

 private:
  ResidualVector residuals_;
  EstimateOptions options_;
};

}  // namespace sim::estimation
