#pragma once
#include "sim/control/loop_shaping/state_space.hpp"

/// Robust stabilisation of a loop with a given shape.
///
/// G_s = M⁻¹ N, normalised coprime factors. K∞ stabilises every (M + Δ_M)⁻¹ (N + Δ_N) with
/// ‖[Δ_N Δ_M]‖∞ < ε; the largest ε follows from two Riccati equations without a search:
///
///   Aᵀ X + X A − X B Bᵀ X + Cᵀ C = 0,   A Z + Z Aᵀ − Z Cᵀ C Z + B Bᵀ = 0
///   1/ε² = γ² = 1 + ρ(X Z)
///
///   K∞ = (A − B Bᵀ X + γ² L⁻ᵀ Z Cᵀ C,  γ² L⁻ᵀ Z Cᵀ,  Bᵀ X),   L = (1 − γ²) 1 + X Z
///
/// for a γ slightly above its minimum. A design with ε ≥ 0.25 is good: K∞ then changes the
/// desired shape only slightly.
///
/// Source: McFarlane and Glover 1992 (paper, 5.2); formulas as in Skogestad and Postlethwaite,
/// Multivariable Feedback Control, 2nd edition, 9.4.
namespace sim::loop_shaping {

struct RobustLoop {
  StateSpace controller;       ///< K∞, for u = K∞ (r − y)
  double margin = 0;           ///< ε of this controller
  double greatest_margin = 0;  ///< largest ε of any controller for this shape
};

/// `gamma_factor`: ratio of γ to its minimum, above 1. Throws std::invalid_argument for a plant
/// with direct feed-through, std::domain_error for one that cannot be stabilised.
RobustLoop stabilised(const StateSpace& shaped, double gamma_factor = 1.1);

/// 1/‖[K; 1](1 + G K)⁻¹[1 G]‖∞ over these frequencies: the ε that K achieves for G.
double margin_of(const StateSpace& plant, const StateSpace& controller, double low_rad_per_s,
                 double high_rad_per_s, int count = 400);

}  // namespace sim::loop_shaping
