#pragma once
#include <Eigen/Core>
#include <vector>

/// A quadratic programme with bounds on the variables:
///
///   min ½ xᵀ H x − cᵀ x,   low ≤ x ≤ high          H symmetric, positive definite
///
/// Solved by a dual active set method (Goldfarb and Idnani 1983, here for bounds only). x is the
/// minimum with the active bounds as equalities; their multipliers w = H x − c are ≥ 0 at low and ≤
/// 0 at high. Each iteration activates the most violated bound. An active bound is released if its
/// multiplier reaches zero during the step. Each step increases the dual objective, so the method
/// terminates. It starts with the active set of the previous call. Near the last solution it needs
/// one step or none.
///
/// With the free variables swept, the tableau contains −H_FF⁻¹, H_FF⁻¹ H_FB and H_BB − H_BF H_FF⁻¹
/// H_FB. Its columns are the directions of all variables and multipliers when one variable moves to
/// its bound. Activating or releasing a bound is one sweep of n² operations.
///
/// No heap after construction.
namespace sim {

class BoxQp {
 public:
  using Matrix = Eigen::MatrixXd;
  using Vector = Eigen::VectorXd;

  explicit BoxQp(Eigen::Index unknowns);

  /// The solution; valid until the next call. Sizes: n × n and n. Throws std::invalid_argument if
  /// low > high or if H is not positive definite.
  const Vector& solve(const Matrix& h, const Vector& c, const Vector& low, const Vector& high);

  /// w = H x − c: 0 for free variables; otherwise the sensitivity of the objective to the bound.
  const Vector& multipliers() const { return w_; }
  /// Number of bounds activated or released by the last call.
  int changes() const { return changes_; }
  /// False: because of rounding, the last call did not converge within 20 changes per variable. Its
  /// result satisfies the bounds and may be slightly suboptimal.
  bool converged() const { return converged_; }
  /// Clears the active set.
  void start_cold() { active_.assign(active_.size(), Bound::free); }

 private:
  enum class Bound : char { free, at_low, at_high };
  void check(const Vector& low, const Vector& high) const;
  void sweep(Eigen::Index k);
  void sweep_free_variables(const Matrix& h);
  void solve_active_set(const Vector& c, const Vector& low, const Vector& high);
  bool release_wrong_signs();
  Eigen::Index most_violated(const Vector& low, const Vector& high) const;
  void activate(Eigen::Index p, double bound, Bound side);
  bool is_free(Eigen::Index k) const { return active_[static_cast<std::size_t>(k)] == Bound::free; }
  Bound& active(Eigen::Index k) { return active_[static_cast<std::size_t>(k)]; }

  Eigen::Index n_;
  Matrix tableau_;
  Vector x_, w_, column_;
  std::vector<Bound> active_;
  static constexpr int max_changes_per_unknown = 20;  // chosen
  int changes_ = 0;
  bool converged_ = true;
};

}  // namespace sim
