#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

#include "sim/model/skeleton/skeleton_model.hpp"
#include "sim/world/step_solver.hpp"

/// The stops of joints, as forces that push back over a time step.
///
///   direction·v⁺ ≤ gap / dt,   f = max(0, G (direction·v⁺ − gap / dt))
///
/// G and the undoing of an overrun: hold_back in step_solver.hpp. Of a spherical joint max_rad
/// bounds the whole rotation α from the starting pose: dα/dt = axis·ω in either frame.
namespace sim {

class JointLimits {
 public:
  explicit JointLimits(const SkeletonModel& model, std::span<const erp::Joint> joints);
  /// The most that `find` can give.
  int most() const { return static_cast<int>(2 * stops_.size()); }
  /// Writes the stops that are near into `forces`, which has room for `most`; returns how many.
  int find(std::span<const JointReading> joints, const Eigen::MatrixXd& h, double dt_s,
           std::span<OneSidedForce> forces) const;

 private:
  struct Stop {
    int joint, first;
    bool spherical;
    double min_rad, max_rad;
  };
  std::vector<Stop> stops_;
};

}  // namespace sim
