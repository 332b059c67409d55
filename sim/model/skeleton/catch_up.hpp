#pragma once
#include <span>
#include <vector>

#include "sim/model/skeleton/joint_path.hpp"

/// From wherever the joints are, and however they move, onto a way that goes on meanwhile: what they
/// are off it goes to nothing with the least jerk.
///
///   q(t) = q_d(t) ⊕ u(t),   u(0) = q ⊖ q_d,  u̇(0) from v,  ü(0) = 0,   u = u̇ = ü = 0 at the end
///   ball joints, in the child's frame:   ω = Eᵀ ω_d + ω_u,   α = Eᵀ α_d − ω_u × Eᵀ ω_d + α_u,
///                                        E = exp [u]×,  ω_u and α_u as in rotation_vector.hpp
namespace sim {

class CatchUp {
 public:
  CatchUp() = default;  ///< nothing to make up for
  CatchUp(std::span<const JointReading> now, std::span<const JointMotion> wanted,
          double duration_s);

  double duration_s() const { return duration_s_; }
  /// Adds what is still missing at `time_s` since it began. No heap.
  void add(double time_s, std::span<JointMotion> wanted) const;

 private:
  std::vector<std::array<double, 3>> starts_;  ///< u(0), by joint
  std::vector<QuinticWay> ways_;               ///< u(s) − u(0)
  double duration_s_ = 0;
};

}  // namespace sim
