#pragma once
#include <array>
#include <vector>

#include "interfaces/robot/skeleton.hpp"

namespace erp {

/// A mass distribution. Inertia about its centre of mass in the body's axes: xx yy zz xy xz yz; the
/// last three are the tensor's entries (−Σ m x y).
struct Mass {
  double mass_kg = 0;
  Vec3 com_m{0, 0, 0};
  std::array<double, 6> inertia_kg_m2{};
};

/// The mass of a body of robot.xml: either its mass_kg, com_m and inertia_kg_m2, or the sum of its
/// solids times density and of its weights. Overlaps of solids count twice.
Mass mass_of(const Body& body);

/// The total of masses that are fixed to each other; all in the same axes.
Mass combined(std::vector<Mass> masses);

/// Whether the mass of the body is computed from its parts.
bool has_mass_from_parts(const Body& body);

}  // namespace erp
