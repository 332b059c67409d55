#pragma once
#include <array>
#include <vector>

#include "interfaces/robot/skeleton.hpp"

namespace erp {

/// A mass distribution. Inertia about its centre of mass in the body's axes: xx yy zz xy xz yz,
/// the last three as they stand in the tensor (−Σ m x y).
struct Mass {
  double mass_kg = 0;
  Vec3 com_m{0, 0, 0};
  std::array<double, 6> inertia_kg_m2{};
};

/// Of a body as robot.xml gives it: either its mass_kg, com_m and inertia_kg_m2, or the sum of its
/// solids times density and of its weights. Solids that overlap count twice.
Mass mass_of(const Body& body);

/// Of all, fixed to each other; in the axes they share.
Mass together(std::vector<Mass> masses);

/// Whether its mass follows from its parts.
bool made_of_parts(const Body& body);

}  // namespace erp
