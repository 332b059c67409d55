#pragma once
#include <Eigen/Core>
#include <vector>

/// A quadratic programme with bounds:
///
///   min ½ xᵀ H x − cᵀ x,   low ≤ x ≤ high          H symmetric, positive definite
///
/// By a dual active set (Goldfarb and Idnani 1983, here for bounds only): x is the least under the
/// bounds it is held at, each of which holds it against its will (multipliers w = H x − c, ≥ 0 at
/// low, ≤ 0 at high). The bound most violated is brought in; on the way, a bound whose multiplier
/// comes to nothing lets go. Each step raises the dual, so it ends. It begins with the bounds that
/// held last time: near the last solution that is a step or none.
///
/// With the free unknowns swept, the tableau holds −H_FF⁻¹, H_FF⁻¹ H_FB and H_BB − H_BF H_FF⁻¹ H_FB:
/// a column of it is the way of all unknowns and multipliers as one is moved to its bound. A bound
/// that comes or goes is one sweep, n² operations.
///
/// No heap after construction.
namespace sim {

class BoxQp {
 public:
  using Matrix = Eigen::MatrixXd;
  using Vector = Eigen::VectorXd;

  explicit BoxQp(Eigen::Index unknowns);

  /// The solution; valid until the next call. Sizes: n × n and n. Throws std::invalid_argument where
  /// low > high, or where H is not positive definite.
  const Vector& solve(const Matrix& h, const Vector& c, const Vector& low, const Vector& high);

  /// w = H x − c: 0 where x is free; how much less the objective would be a unit beyond the bound.
  const Vector& multipliers() const { return w_; }
  /// Bounds brought in or let go by the last call.
  int changes() const { return changes_; }
  /// False: rounding kept the last call from an end within 20 changes an unknown; what it gave obeys
  /// the bounds, and may be a little beside the best.
  bool settled() const { return settled_; }
  /// Forgets which bounds held.
  void start_cold() { held_.assign(held_.size(), Held::free); }

 private:
  enum class Held : char { free, at_low, at_high };
  void check(const Vector& low, const Vector& high) const;
  void sweep(Eigen::Index k);
  void free_all_but_held(const Matrix& h);
  void solve_held(const Vector& c, const Vector& low, const Vector& high);
  bool let_go_of_unwilling();
  Eigen::Index most_violated(const Vector& low, const Vector& high) const;
  void bring_in(Eigen::Index p, double bound, Held side);
  bool is_free(Eigen::Index k) const { return held_[static_cast<std::size_t>(k)] == Held::free; }
  Held& held(Eigen::Index k) { return held_[static_cast<std::size_t>(k)]; }

  Eigen::Index n_;
  Matrix tableau_;
  Vector x_, w_, column_;
  std::vector<Held> held_;
  static constexpr int most_changes = 20;
  int changes_ = 0;
  bool settled_ = true;
};

}  // namespace sim
