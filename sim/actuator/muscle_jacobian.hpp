#pragma once
#include "sim/actuator/routing.hpp"
#include "sim/skeleton/skeleton_model.hpp"

namespace sim {

/// ∂L/∂q of a path (paper, eq. 7), one entry a coordinate of the model, which must stand in the
/// posture the shape was solved at: J v is dL/dt and −F Jᵀ the torques of tension F.
/// Analytic: by virtual work, from the pulls at the path's points and pulleys.
inline void length_gradient(const PathShape& shape, const SkeletonModel& model,
                            Eigen::VectorXd& row) {
  row.setZero(model.coordinates());
  for (const PathPull& pull : shape.pulled())
    if (!pull.direction.isZero(0)) model.add_torques(pull.body, pull.at_m, -pull.direction, row);
}

}  // namespace sim
