#pragma once
#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <span>
#include <vector>

/// The tensions of all tendons over a time step, each implicit in the motion that all of them
/// cause.
///
///   f_k = κ (x + c₁ dt ẋ + c₂ dt ẋ⁺) + D ẋ⁺ ≥ 0        ẋ = J v + r ω,  0 where the tendon is slack
///   H v⁺ + dt Jᵀ f = H v + dt τ                          τ all other torques, C and τ_G included
///   ⇒ (H + dt Jᵀ G J) v⁺ = H v + dt τ − dt Jᵀ (κ (x + c₁ dt ẋ) + G r ω),   G = κ c₂ dt + D
///
/// x stretch and J its rate over the joints, at the start of the step. A tendon that would push is
/// left out and the rest solved again. With positions moved by q⁺ = q + dt v⁺ an oscillator of
/// k = dt² κ J W Jᵀ keeps (1 − k c₁)/(1 + k c₂) of its phase space each step, so
///
///   c₁ = (θ − 1)/2, c₂ = (3θ − 1)/2:   θ = ½ keeps all of it, θ = 1 is backward Euler;
///   both are stable for any stiffness.
///
/// By default θ = ½ + ½ k/(4 + k): energy is kept where the step resolves the oscillation, to
/// fourth order in dt, and drained where it does not.
/// Source: linearised implicit integration (Baraff, Witkin 1998); c₁, c₂ and θ(k) are ours.
namespace sim {

struct StretchedTendon {
  double stiffness_N_per_m = 0, damping_N_s_per_m = 0;
  double stretch_m = 0;        ///< x
  double rate_m_per_s = 0;     ///< ẋ
  double winding_m_per_s = 0;  ///< r ω
};

class TendonSolver {
 public:
  /// `theta`: ½ … 1 for all tendons, 0 to let each step choose.
  TendonSolver(int tendons, int coordinates, double theta = 0);

  /// `rows`: J, one row a tendon. `momentum`: H v + dt τ. Returns f in N. No heap.
  std::span<const double> solve(const Eigen::MatrixXd& h, const Eigen::MatrixXd& rows,
                                const Eigen::VectorXd& momentum,
                                std::span<const StretchedTendon> tendons, double dt_s);

 private:
  struct Share {
    double gain = 0;   ///< G
    double start = 0;  ///< κ (x + c₁ dt ẋ) + G r ω
    bool pulls = false;
  };
  double theta_of(const StretchedTendon& tendon, double mobility, double dt_s) const;
  /// Of the tendons that pull; true if none of them has to be dropped.
  bool settle(const Eigen::MatrixXd& h, const Eigen::MatrixXd& rows,
              const Eigen::VectorXd& momentum, double dt_s);

  double theta_;
  std::vector<Share> shares_;
  std::vector<double> tension_N_;
  Eigen::MatrixXd system_;
  Eigen::VectorXd right_, velocity_, mobile_;
  Eigen::LLT<Eigen::MatrixXd> inertia_, factor_;
};

}  // namespace sim
