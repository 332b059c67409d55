#pragma once
#include <cmath>
#include <string>

#include "interfaces/xml/values.hpp"
#include "sim/model/effects/effect.hpp"
#include "sim/model/effects/joint/passive_stiffness.hpp"

namespace sim::effects {

/// Bending of a bone: a spring hinge at the centre of mass, parallel to the joint's axis, connects
/// the outer half to the inner half.
///
///   halves of m/2 and I/4, centres at c ± d c/|c|,  d = √(I/2m);  their sum has m, c and I
///   τ = −k δ − D ω_δ
///
/// I: the mean of the two principal inertias transverse to the body's length, taken as I_xx.
/// Tendons, pulleys and child bones stay attached to the inner half. A spring stiffer than 1000
/// Nm/rad is treated as rigid. A bone bends at one point only; the effect does not apply to bones
/// on ball joints.
/// Source: De Luca, Siciliano, 1991 (one assumed mode).
struct LinkFlexibility {
  static constexpr About about{"skeleton_link_flexibility", Stage::skeleton, Seat::body,
                               "steps and fast reversals"};

  double compliance_rad_per_Nm = 0;     // 1/k
  double damping_Nm_s_per_rad = 0.005;  // D

  void visit(auto& v) {
    v("compliance_rad_per_Nm", compliance_rad_per_Nm, Bounds{0, 1});
    v.shape("damping_Nm_s_per_rad", damping_Nm_s_per_rad, Bounds{0, 1});
  }
  void change_robot(auto& robot, const auto& on) const {
    if (compliance_rad_per_Nm < rigid_rad_per_Nm) return;
    for (auto& part : robot.skeletons)
      for (auto& body : part.bodies)
        if (body.name == on + "_outer") return;
    for (auto& part : robot.skeletons)
      for (std::size_t j = 0; j < part.joints.size(); ++j)
        if (const auto& joint = part.joints[j];
            joint.child == on && joint.type == decltype(joint.type)::revolute)
          return split(robot, part, joint, on);
  }

 private:
  static constexpr double rigid_rad_per_Nm = 1e-3;  // chosen: 1000 Nm/rad

  void split(auto& robot, auto& part, auto hinge, const std::string& on) const {
    for (std::size_t b = 0; b < part.bodies.size(); ++b) {
      if (part.bodies[b].name != on) continue;
      auto outer = part.bodies[b];
      auto& inner = part.bodies[b];
      const auto c = outer.com_m;
      const double com_distance_m = std::hypot(c[0], c[1], c[2]);
      if (com_distance_m == 0 || outer.mass_kg == 0) return;
      const double offset_m = std::sqrt(outer.inertia_kg_m2[0] / (2 * outer.mass_kg));
      outer.name = on + "_outer", outer.parts.clear();
      for (std::size_t i = 0; i < 3; ++i) {
        outer.com_m[i] = offset_m * c[i] / com_distance_m,
        inner.com_m[i] = c[i] * (1 - offset_m / com_distance_m);
        for (auto* body : {&outer, &inner}) {
          body->inertia_kg_m2[i] /= i == 2 ? 2 : 4;
          body->products_kg_m2[i] /= 4;
        }
      }
      outer.mass_kg /= 2, inner.mass_kg /= 2;
      hinge.name = on + "_bend", hinge.parent = on, hinge.child = outer.name, hinge.at_m = c;
      hinge.min_rad = -1, hinge.max_rad = 1, hinge.initial_rad = 0;
      hinge.coulomb_Nm = 0, hinge.viscous_Nm_s_per_rad = damping_Nm_s_per_rad;
      part.bodies.push_back(outer), part.joints.push_back(hinge);
      add_spring(robot, hinge.name);
      return;
    }
  }
  void add_spring(auto& robot, const std::string& hinge) const {
    auto& spring = robot.effects.emplace_back();
    spring.type = JointPassiveStiffness::about.type, spring.on = hinge;
    spring.parameters.push_back(
        {{}, "stiffness_Nm_per_rad", xml::write_number(1 / compliance_rad_per_Nm)});
  }
};

}  // namespace sim::effects
