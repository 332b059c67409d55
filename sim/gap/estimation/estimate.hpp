#pragma once
#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cmath>

#include "sim/gap/estimation/residual_vector.hpp"
#include "sim/gap/estimation/unknowns.hpp"
#include "interfaces/parallel/pool.hpp"

/// All constants of a robot, and the parameters of effects beside them, estimated together from the
/// stage residuals of recordings: maximum a posteriori by Gauss-Newton.
///
///   min over x, p   Σ_s w_s Σ_k z_sk(x, p)² + prior(x)    z: residual_vector.hpp, prior: unknowns.hpp
///   w_s = 1/(4 c_s v_s)    c_s = max(1, ⟨z_s²⟩): a stage that keeps more than noise counts less
///                          v_s: windows that one independent one stands for, 1 + 2 Σ ρ_l
///                          4: chosen, for what the laws themselves approximate
///
/// x: deviations of constants in tolerances; p: parameters of effects,
/// without a prior but within their bounds. The covariance is the inverse of the Hessian.
/// Source: Gelman et al., Bayesian Data Analysis, ch. 4 and 17.
namespace sim::estimation {

struct EstimateOptions {
  int iterations = 30;
  int threads = 2;
  std::uint64_t seed = 1;
  const Pool* pool =
      nullptr;  ///< where derivatives are taken and effects screened; none: on `threads`
};

/// A point with what is known about it.
struct Estimate {
  Point point;
  Explained explained;  ///< the recordings, by the robot there
  Eigen::VectorXd z, weight;
  Eigen::VectorXd gradient;              ///< of half the cost
  Eigen::SparseMatrix<double> jacobian;  ///< ∂z/∂unknown
  Eigen::MatrixXd covariance;            ///< of x, then of each fitted parameter in its unit
  std::vector<double> mean_square;       ///< ⟨z²⟩, one a stage in the order of the residuals
  std::vector<bool> bound;               ///< of each unknown: a parameter that ends at a bound
  double cost = 0;

  double sigma(std::size_t k) const {
    return std::sqrt(covariance(Eigen::Index(k), Eigen::Index(k)));
  }
};

class Estimator {
 public:
  /// `nominal` and `episodes` stay with the caller. Throws as residuals::Stages.
  Estimator(const erp::Robot& nominal, std::span<const residuals::Episode> episodes,
            const EstimateOptions& options = {});

  const ResidualVector& residuals() const { return residuals_; }
  const EstimateOptions& options() const { return options_; }

  Estimate run(const Uncertain& uncertain, Point start) const;
  /// From where another ended, with its derivatives until a step shows that they no longer hold.
  Estimate continued(const Uncertain& uncertain, Estimate from) const;
  /// The same for few steps, as a candidate beside `base`: derivatives by the constants and weights
  /// are those of `base`, on one thread.
  Estimate beside(const Uncertain& uncertain, const Estimate& base, Point start,
                  int iterations) const;

 private:
  ResidualVector residuals_;
  EstimateOptions options_;
};

}  // namespace sim::estimation
