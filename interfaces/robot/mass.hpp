#pragma once
#include <array>
#include <vector>

#include "interfaces/robot/skeleton.hpp"

namespace erp {

/// Mass, centre of mass and inertia. The inertia is about the centre of mass, in the axes of the
/// body: xx yy zz xy xz yz; the last three are the entries of the tensor (−Σ m x y).
struct Mass {
  double mass_kg = 0;
  Vec3 com_m{0, 0, 0};
  std::array<double, 6> inertia_kg_m2{};
};

/// The mass of a body of robot.xml: either the given mass_kg, com_m and inertia_kg_m2, or the total
/// of its solids (volume times density) and its weights. Overlaps of solids count twice.
Mass mass_of(const Body& body);

/// The total of masses that are rigidly connected; all in the same frame.
Mass combined(std::vector<Mass> masses);

/// Whether the mass of the body is computed from its parts.
bool has_mass_from_parts(const Body& body);

}  // namespace erp
