#pragma once
#include <Eigen/Core>
#include <span>
#include <vector>

#include "sim/model/skeleton/skeleton_model.hpp"
#include "sim/world/step_solver.hpp"

/// Joint limits, as forces that push back over a time step.
///
///   direction·v⁺ ≤ gap / dt,   f = max(0, G (direction·v⁺ − gap / dt))
///
/// G and the correction of an overrun: set_stop in step_solver.hpp. For a spherical joint max_rad
/// bounds the angle α of the rotation from the starting pose: dα/dt = axis·ω in either frame. No
/// restitution.
namespace sim {

class JointLimits {
 public:
  explicit JointLimits(const SkeletonModel& model, std::span<const erp::Joint> joints);
  /// The largest number of forces that `find` can write.
  int max_count() const { return static_cast<int>(2 * stops_.size()); }
  /// Writes the limits that are near to `forces`, which has room for `max_count`. Returns their
  /// number.
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
