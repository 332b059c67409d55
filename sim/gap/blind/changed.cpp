// A robot with other masses, a tilted base and flexible bones.
#include <Eigen/Geometry>
#include <cmath>

#include "interfaces/robot/mass.hpp"
#include "sim/gap/blind/plant.hpp"

namespace sim::blind {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

struct Solid {
  double mass_kg;
  Vector3d com_m;
  Matrix3d inertia_about_com;
};

Solid solid_of(const erp::Body& body) {
  const erp::Mass m = erp::mass_of(body);
  const auto& i = m.inertia_kg_m2;
  Matrix3d inertia;
  inertia << i[0], i[3], i[4], i[3], i[1], i[5], i[4], i[5], i[2];
  return {m.mass_kg, {m.com_m[0], m.com_m[1], m.com_m[2]}, inertia};
}

void set_mass(erp::Body& body, const Solid& s) {
  const Matrix3d& i = s.inertia_about_com;
  body.mass_kg = s.mass_kg, body.com_m = {s.com_m[0], s.com_m[1], s.com_m[2]};
  body.inertia_kg_m2 = {i(0, 0), i(1, 1), i(2, 2)};
  body.products_kg_m2 = {i(0, 1), i(0, 2), i(1, 2)};
  body.density_kg_per_m3.reset();
  std::erase_if(body.parts,
                [](const erp::Part& part) { return std::holds_alternative<erp::Weight>(part); });
}

Matrix3d point_inertia(double mass_kg, const Vector3d& r) {
  return mass_kg * (r.squaredNorm() * Matrix3d::Identity() - r * r.transpose());
}

/// Two rigid bodies joined to one (parallel axis theorem).
Solid joined(const Solid& a, const Solid& b) {
  Solid sum{a.mass_kg + b.mass_kg, {}, {}};
  sum.com_m = (a.mass_kg * a.com_m + b.mass_kg * b.com_m) / sum.mass_kg;
  sum.inertia_about_com = a.inertia_about_com + point_inertia(a.mass_kg, a.com_m - sum.com_m) +
                          b.inertia_about_com + point_inertia(b.mass_kg, b.com_m - sum.com_m);
  return sum;
}

Solid with_hidden_effects(Solid s, const BodyEffects& q) {
  constexpr double payload_at_m = 0.25;  // as in the library of effects
  const Vector3d along = s.com_m.normalized();
  s.mass_kg *= 1 + q.mass;
  s.inertia_about_com *= (1 + q.mass) * (1 + q.inertia);
  s.com_m += q.com_m * along;
  if (q.payload_kg > 0) s = joined(s, {q.payload_kg, payload_at_m * along, Matrix3d::Zero()});
  return s;
}

/// Splits a body at its centre of mass into two equal rods on a hinge, with the same total mass.
void split_by_hinge(erp::Skeleton& part, std::size_t b) {
  erp::Body& inner = part.bodies[b];
  erp::Body outer = inner;
  const Solid total = solid_of(inner);
  const Vector3d along = total.com_m.normalized();
  const double across = total.inertia_about_com(0, 0);
  // A rod of length l has I = m l²/12. The centre of each half is at l/4, thus at √(3 I / (4 m)).
  const double half_com_m = std::sqrt(0.75 * across / total.mass_kg);
  const auto half = [&](double sign) {
    Matrix3d inertia =
        (total.inertia_about_com - point_inertia(total.mass_kg, half_com_m * along)) / 2;
    return Solid{total.mass_kg / 2, total.com_m + sign * half_com_m * along, inertia};
  };
  outer.name = inner.name + "_outer", outer.parts.clear();
  set_mass(inner, half(-1));
  Solid outer_half = half(1);
  outer_half.com_m -= total.com_m;  // in the frame of the outer body, whose origin is the hinge
  set_mass(outer, outer_half);
  for (std::size_t j = 0; j < part.joints.size(); ++j) {
    if (part.joints[j].child != inner.name) continue;
    erp::Joint hinge = part.joints[j];
    hinge.name = inner.name + "_bows", hinge.parent = inner.name, hinge.child = outer.name;
    hinge.at_m = {total.com_m[0], total.com_m[1], total.com_m[2]};
    hinge.min_rad = -1, hinge.max_rad = 1, hinge.initial_rad = 0;  // chosen: never reached
    hinge.coulomb_Nm = 0, hinge.viscous_Nm_s_per_rad = 0.005;      // chosen
    part.bodies.push_back(outer), part.joints.push_back(hinge);
    return;
  }
}

}  // namespace

erp::Robot changed(const erp::Robot& nominal, const HiddenEffects& hidden_effects) {
  erp::Robot robot = nominal;
  robot.effects.clear();
  const Matrix3d world_to_base = (Eigen::AngleAxisd(hidden_effects.tilt_y_rad, Vector3d::UnitY()) *
                                  Eigen::AngleAxisd(hidden_effects.tilt_x_rad, Vector3d::UnitX()))
                                     .toRotationMatrix()
                                     .transpose();
  for (erp::Skeleton& part : robot.skeletons) {
    if (auto& g = part.gravity_m_per_s2) {
      const Vector3d turned = world_to_base * Vector3d((*g)[0], (*g)[1], (*g)[2]);
      *g = {turned[0], turned[1], turned[2]};
    }
    const std::size_t count = part.bodies.size();
    for (std::size_t b = 0; b < count; ++b) {
      const auto effects = hidden_effects.bodies.find(part.bodies[b].name);
      if (effects == hidden_effects.bodies.end()) continue;
      set_mass(part.bodies[b], with_hidden_effects(solid_of(part.bodies[b]), effects->second));
      if (effects->second.bend_rad_per_Nm > 0) split_by_hinge(part, b);
    }
  }
  return robot;
}

}  // namespace sim::blind
