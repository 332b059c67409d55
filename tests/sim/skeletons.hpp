#pragma once
#include "tests/sim/rigs.hpp"

/// Robots without actuators, whose motion can be computed by hand.
namespace rigs {

inline erp::Body root(const std::string& name = "base") {
  erp::Body body;
  body.name = name;
  return body;
}

inline erp::Body bone(const std::string& name, double mass_kg, xml::Vec3 com_m,
                      xml::Vec3 inertia_kg_m2) {
  erp::Body body;
  body.name = name, body.mass_kg = mass_kg, body.com_m = com_m;
  body.inertia_kg_m2 = inertia_kg_m2;
  return body;
}

inline erp::Joint joint(const std::string& name, erp::JointType type, const std::string& parent,
                        const std::string& child, xml::Vec3 at_m = {0, 0, 0}) {
  erp::Joint j;
  j.name = name, j.type = type, j.parent = parent, j.child = child, j.at_m = at_m;
  j.min_rad = -100, j.max_rad = 100;
  return j;
}

inline erp::Robot robot(std::vector<erp::Body> bodies, std::vector<erp::Joint> joints,
                        xml::Vec3 gravity_m_per_s2 = {0, 0, -9.81}) {
  erp::Robot r;
  r.name = "rig";
  erp::Skeleton skeleton;
  skeleton.gravity_m_per_s2 = gravity_m_per_s2;
  skeleton.bodies = std::move(bodies), skeleton.joints = std::move(joints);
  r.skeletons = {skeleton};
  return r;
}

/// A rod about +y, its centre of mass `l` below the joint; inertia about the joint I.
inline constexpr double pendulum_mass_kg = 0.8, pendulum_l_m = 0.12, pendulum_I_kg_m2 = 0.01752;
inline erp::Robot pendulum(double initial_rad, double viscous = 0, double coulomb = 0) {
  erp::Joint hinge = joint("hinge", erp::JointType::revolute, "base", "rod");
  hinge.initial_rad = initial_rad;
  hinge.viscous_Nm_s_per_rad = viscous, hinge.coulomb_Nm = coulomb;
  return robot({root(), bone("rod", pendulum_mass_kg, {0, 0, -pendulum_l_m}, {0.006, 0.006, 4e-4})},
               {hinge});
}

/// A rigid body on a ball joint.
inline erp::Robot ball(double viscous = 0, double coulomb = 0, xml::Vec3 gravity = {0, 0, 0},
                       xml::Vec3 com = {0, 0, 0}) {
  erp::Joint shoulder = joint("shoulder", erp::JointType::spherical, "base", "arm");
  shoulder.viscous_Nm_s_per_rad = viscous, shoulder.coulomb_Nm = coulomb;
  return robot({root(), bone("arm", 1.0, com, {0.02, 0.015, 0.01})}, {shoulder}, gravity);
}

}  // namespace rigs
