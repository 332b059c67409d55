#pragma once
#include <vector>

#include "sim/model/actuator/routing.hpp"
#include "sim/model/skeleton/skeleton_model.hpp"

namespace sim {

/// The joints that a tendon acts on: those that move some of its points and pulleys, but not all.
struct Levers {
  std::vector<int> coordinates;  ///< of the model, in ascending order
  std::vector<std::vector<int>>
      of_element;  ///< for each element, those of `coordinates` that move it
};

Levers levers_of(const Routing& routing, const SkeletonModel& model);

/// ∂L/∂q of a path (paper, eq. 7), one entry per coordinate of the model. The model must be placed
/// in the posture for which `shape` was solved. J v is dL/dt, and −F Jᵀ are the torques of tension
/// F. Analytic, by virtual work, from the pulls at the path's points and pulleys. Exactly zero for
/// coordinates that do not change the length.
inline void length_gradient(const PathShape& shape, const Levers& levers,
                            const SkeletonModel& model, Eigen::VectorXd& row) {
  row.setZero(model.coordinates());
  for (std::size_t k = 0; k < levers.of_element.size(); ++k) {
    const PathPull& pull = shape.pulls[k];
    if (pull.direction.isZero(0) && pull.moment_m.isZero(0)) continue;
    Vec6 wrench_of_pull = wrench(pull.at_m, -pull.direction);
    wrench_of_pull.head<3>() -= pull.moment_m;
    for (const int d : levers.of_element[k]) row[d] += model.axis(d).dot(wrench_of_pull);
  }
}

}  // namespace sim
