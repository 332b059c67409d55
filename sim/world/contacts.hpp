#pragma once
#include <memory>
#include <span>
#include <vector>

#include "sim/model/skeleton/skeleton_model.hpp"
#include "sim/world/step_solver.hpp"

/// Contacts between bodies, as forces that push them apart over a time step.
///
///   −n·(v_a − v_b) ≤ gap / dt,   f = max(0, G (−n·(v_a − v_b) − gap / dt))
///
/// n: direction from body b to body a at the nearest points of two of their solids, found by
/// Bullet's GJK; v: velocities of these points. G and the correction of an overlap: set_stop in
/// step_solver.hpp. One point per pair of solids, no friction, no restitution: bodies with flat
/// faces may rock on them. A box is rounded by a tenth of its shortest edge, at most 1 mm.
namespace sim {

class Contacts {
 public:
  Contacts(const RobotTree& tree, const erp::Robot& robot);
  ~Contacts();
  /// The largest number of contacts that `find` can write: pairs of solids.
  int max_count() const;
  /// Writes the near contacts in the model's current posture to `forces`, which has room for
  /// `max_count`. Returns their number. No heap.
  int find(const SkeletonModel& model, double dt_s, std::span<OneSidedForce> forces) const;

 private:
  struct Solids;
  std::unique_ptr<Solids> solids_;
};

}  // namespace sim
