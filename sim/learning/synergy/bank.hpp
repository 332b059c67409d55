#pragma once
#include <cstdint>
#include <random>
#include <vector>

#include "interfaces/xml/fields.hpp"
#include "sim/learning/synergy/plan.hpp"

/// The stored motor plans, and how new ones come from them (paper, 5.5).
///
///   β_k ∝ v_k² exp(−|x − x_k|²/(2 σ²)),   Σ β_k = 1
///   plan = Σ γ_k plan_k,   γ_k = β_k (1 + (x_k − x̄)ᵀ (S + ε σ²)⁻¹ (x − x̄))
///   v_k ← v_k + η β_k (r − v_k)
///
/// x is the target, x_k where plan k brought the hand, r the reward of the trial; x̄ and S are mean and
/// scatter of the x_k by β. γ puts right that the plans near a target do not lie about it evenly: were
/// all linear, Σ γ_k plan_k would lead there. Beyond what is known nothing is linear: of x − x̄ no more
/// than `lean_m` counts. σ is `basis_m`, or the distance to the fourth nearest plan where plans are few.
namespace sim::synergy {

struct BankOptions {
  double basis_m = 0.04;  ///< chosen
  double rate = 0.3;      ///< η; chosen
  double lean_m = 0.07;   ///< chosen: plans led farther out put the torso out of joint
  int most = 200;         ///< plans kept; chosen
  void visit(auto& v) {
    v("basis_m", basis_m, xml::positive);
    v("lean_m", lean_m, xml::at_least_zero);
    v("rate", rate, xml::Range{0, 1});
    v("most", most, xml::Range{1, 1e5});
  }
};

struct Blend {
  MotorPlan plan;
  std::vector<double> credits;  ///< β, by stored plan
};

/// How a plan is varied to explore.
struct Exploring {
  double weights = 0.1;     ///< of each weight, a share of it; and of all together
  double weights_m = 2e-4;  ///< of each weight beside that
  double rise = 0.1;        ///< of T, a share
  double beyond = 0.05;
  void visit(auto& v) {
    v("explore_weights", weights, xml::at_least_zero);
    v("explore_weights_m", weights_m, xml::at_least_zero);
    v("explore_rise", rise, xml::at_least_zero);
    v("explore_beyond", beyond, xml::at_least_zero);
  }
};

class Bank {
 public:
  Bank() = default;
  Bank(const BankOptions& options, std::vector<MotorPlan> plans)
      : options_(options), plans_(std::move(plans)) {}

  const std::vector<MotorPlan>& plans() const { return plans_; }
  /// Throws std::invalid_argument: there is no plan.
  Blend blend(const Eigen::Vector3d& target_m) const;
  /// What a blend of this bank, as it still is, was rewarded with.
  void credit(const std::vector<double>& credits, double reward);
  /// Of two plans that lead to nearly one place the less valuable one goes when there are too many.
  void add(MotorPlan plan);
  void trim() { cut(static_cast<std::size_t>(options_.most)); }
  /// Leaves so many: the key synergies.
  void cut(std::size_t count);

 private:
  BankOptions options_;
  std::vector<MotorPlan> plans_;
};

MotorPlan varied(MotorPlan plan, const Exploring& by, std::mt19937_64& dice);

/// How many synergies the plans' weights consist of: principal components, about zero, that hold so
/// large a share of their squares.
int components(const Bank& bank, double share);

}  // namespace sim::synergy
