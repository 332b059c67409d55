#pragma once
#include <cstdint>
#include <random>
#include <vector>

#include "interfaces/xml/fields.hpp"
#include "sim/learning/synergy/plan.hpp"

/// The stored motor plans, and new plans blended from them (paper, 5.5).
///
///   β_k ∝ v_k² exp(−|x − x_k|²/(2 σ²)),   Σ β_k = 1
///   plan = Σ γ_k plan_k,   γ_k = β_k (1 + (x_k − x̄)ᵀ (S + ε σ²)⁻¹ (x − x̄))
///   v_k ← v_k + η β_k (r − v_k)
///
/// x is the target, x_k the place that the hand reached with plan k, r the reward of the trial; x̄
/// and S are the mean and scatter of the x_k weighted by β. γ corrects for plans that do not
/// surround a target evenly: for a linear robot Σ γ_k plan_k reaches the target. Extrapolation is
/// not linear: |x − x̄| is limited to `max_extrapolation_m`. σ is `basis_m`, or the distance to the
/// fourth nearest plan if that distance is larger.
namespace sim::synergy {

struct BankOptions {
  double basis_m = 0.04;
  double rate = 0.3;
  double max_extrapolation_m = 0.07;
  int capacity = 200;
  void visit(auto& v) {
    v.former("lean_m", "max_extrapolation_m"), v.former("most", "capacity");
    v("basis_m", basis_m,
      {xml::positive, "Width σ of the neighbourhood in which plans are blended; chosen."});
    v("max_extrapolation_m", max_extrapolation_m,
      {xml::at_least_zero,
       "Largest extrapolation from the mean of the blended plans; larger ones dislocated the "
       "torso; chosen."});
    v("rate", rate,
      {xml::Range{0, 1}, "Rate η at which the value of a plan follows the rewards; chosen."});
    v("capacity", capacity, {xml::Range{1, 1e5}, "Largest number of stored plans; chosen."});
  }
};

struct Blend {
  MotorPlan plan;
  std::vector<double> credits;  ///< β, by stored plan
};

/// Standard deviations of the variation of a plan.
struct Exploration {
  double weights = 0.1;
  double weights_m = 2e-4;
  double rise = 0.1;
  double overshoot = 0.05;
  void visit(auto& v) {
    v.former("explore_beyond", "explore_overshoot");
    v("explore_weights", weights,
      {xml::at_least_zero,
       "Relative standard deviation of each weight, and of a common factor of all weights; "
       "chosen."});
    v("explore_weights_m", weights_m,
      {xml::at_least_zero, "Absolute standard deviation of each weight; chosen."});
    v("explore_rise", rise,
      {xml::at_least_zero, "Relative standard deviation of the rise time T; chosen."});
    v("explore_overshoot", overshoot,
      {xml::at_least_zero, "Standard deviation of the overshoot; chosen."});
  }
};

class Bank {
 public:
  Bank() = default;
  Bank(const BankOptions& options, std::vector<MotorPlan> plans)
      : options_(options), plans_(std::move(plans)) {}

  const std::vector<MotorPlan>& plans() const { return plans_; }
  /// Throws std::invalid_argument if there is no plan.
  Blend blend(const Eigen::Vector3d& target_m) const;
  /// Credits the contributors of a blend with its reward. The bank must not have changed since the
  /// blend.
  void credit(const std::vector<double>& credits, double reward);
  /// Stores a plan.
  void add(MotorPlan plan);
  /// Reduces the bank to its capacity.
  void trim() { cut(static_cast<std::size_t>(options_.capacity)); }
  /// Removes plans until `count` remain: of the two plans whose places are nearest to each other,
  /// the less valuable one is removed first.
  void cut(std::size_t count);

 private:
  BankOptions options_;
  std::vector<MotorPlan> plans_;
};

/// A random variation of a plan.
MotorPlan varied(MotorPlan plan, const Exploration& exploration, std::mt19937_64& random);

/// Number of synergies in the plans' weights: uncentred principal components that explain the given
/// fraction of their sum of squares.
int components(const Bank& bank, double fraction);

}  // namespace sim::synergy
