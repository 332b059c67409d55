#include <algorithm>
#include <map>

#include "interfaces/robot/check.hpp"
#include "interfaces/robot/mass.hpp"
#include "interfaces/xml/values.hpp"

namespace erp::robot_check {
namespace {

using xml::quote;
using xml::write_number;

/// The joint that moves each body, by the name of the body; the first one if several joints move
/// it.
using MovedBy = std::map<std::string, const Joint*>;

MovedBy check_one_joint_per_body(const std::vector<Joint>& joints, Findings& findings) {
  MovedBy moved_by;
  for (const Joint& joint : joints) {
    const auto [first, is_new] = moved_by.emplace(joint.child, &joint);
    if (!is_new)
      findings.add(joint,
                   "child=" + quote(joint.child) + " is already moved by joint " +
                       quote(first->second->name),
                   "a body is moved by one joint: remove one");
  }
  return moved_by;
}

/// The joints from `joint` up to the root. In a loop: each of its joints once.
std::vector<const Joint*> towards_root(const Joint& joint, const MovedBy& moved_by) {
  std::vector<const Joint*> chain{&joint};
  for (auto next = moved_by.find(joint.parent); next != moved_by.end();
       next = moved_by.find(chain.back()->parent)) {
    if (std::find(chain.begin(), chain.end(), next->second) != chain.end()) break;
    chain.push_back(next->second);
  }
  return chain;
}

void check_loops(const std::vector<Joint>& joints, const MovedBy& moved_by, Findings& findings) {
  std::vector<const Joint*> reported;
  for (const Joint& joint : joints) {
    const auto chain = towards_root(joint, moved_by);
    const bool is_loop = chain.back()->parent == joint.child;
    if (!is_loop || std::find(reported.begin(), reported.end(), &joint) != reported.end()) continue;
    reported.insert(reported.end(), chain.begin(), chain.end());
    std::string loop = joint.child;
    for (const Joint* j : chain) loop += " < " + j->parent;
    findings.add(joint, "the joints form a loop: " + loop,
                 "a skeleton is a tree: remove one of its joints");
  }
}

void check_free(const Joint& joint, const MovedBy& moved_by, Findings& findings) {
  if (joint.type != JointType::free) return;
  if (const auto joint_above = moved_by.find(joint.parent); joint_above != moved_by.end())
    findings.add(
        joint,
        "parent=" + quote(joint.parent) + " is moved by joint " + quote(joint_above->second->name),
        "a free body floats relative to a root body: give one");
  if (joint.viscous_Nm_s_per_rad > 0 || joint.coulomb_Nm > 0)
    findings.add(joint, "a free joint has no friction",
                 "remove viscous_Nm_s_per_rad and coulomb_Nm");
}

void check_joint(const Joint& joint, Findings& findings) {
  if (joint.type != JointType::revolute) return;
  if (joint.axis == Vec3{0, 0, 0})
    findings.add(joint, "axis=\"0 0 0\" has no direction", "give the direction of the hinge");
  if (joint.min_rad >= joint.max_rad)
    findings.add(joint,
                 "min_rad=\"" + write_number(joint.min_rad) + "\" is not below max_rad=\"" +
                     write_number(joint.max_rad) + "\"",
                 "swap them, or make the joint fixed");
  else if (joint.initial_rad < joint.min_rad || joint.initial_rad > joint.max_rad)
    findings.add(
        joint, "initial_rad=\"" + write_number(joint.initial_rad) + "\" is outside the limits",
        "give a number from " + write_number(joint.min_rad) + " to " + write_number(joint.max_rad));
}

/// Every mass distribution satisfies I₁ ≤ I₂ + I₃, for each of the three as I₁.
bool is_possible(const Vec3& inertia) {
  constexpr double rounding = 1e-9;  // relative, for numbers written in decimal
  const double sum = inertia[0] + inertia[1] + inertia[2];
  return *std::max_element(inertia.begin(), inertia.end()) <= sum / 2 * (1 + rounding);
}

void check_body(const Body& body, const MovedBy& moved_by, Findings& findings) {
  const auto joint = moved_by.find(body.name);
  if (joint != moved_by.end() && mass_of(body).mass_kg == 0)
    findings.add(
        body,
        quote(body.name) + " has no mass but joint " + quote(joint->second->name) + " moves it",
        "add mass_kg, or density_kg_per_m3 for its solids");
  if (has_mass_from_parts(body) && body.mass_kg > 0)
    findings.add(body,
                 "mass_kg=" + quote(write_number(body.mass_kg)) +
                     " is given in addition to a density or a weight, which determine the mass",
                 "remove one of them");
  if (!is_possible(body.inertia_kg_m2))
    findings.add(body,
                 "inertia_kg_m2=\"" + xml::Codec<Vec3>::write(body.inertia_kg_m2) +
                     "\" is not a possible inertia",
                 "none of the three may exceed the sum of the other two");
}

bool is_solid(const Part& part) { return !std::holds_alternative<Weight>(part); }

void check_contact(const Robot& robot, const Contact& contact, const MovedBy& moved_by,
                   Findings& findings) {
  if (contact.body == contact.on)
    return findings.add(contact, quote(contact.body) + " cannot touch itself", "name two bodies");
  if (!moved_by.contains(contact.body) && !moved_by.contains(contact.on))
    return findings.add(contact,
                        "neither " + quote(contact.body) + " nor " + quote(contact.on) + " moves",
                        "name a body that a joint moves");
  for (const Body& body : robot.bodies())
    if ((body.name == contact.body || body.name == contact.on) &&
        std::ranges::none_of(body.parts, is_solid))
      findings.add(contact, quote(body.name) + " has no shape",
                   "give it a <sphere>, <capsule> or <box>");
}

void check_gravity(const Robot& robot, Findings& findings) {
  const Skeleton* first = nullptr;
  for (const Skeleton& part : robot.skeletons) {
    if (!part.gravity_m_per_s2) continue;
    if (first)
      findings.add(part, "gravity_m_per_s2 is given twice",
                   "keep one; the first is at " + place_text(first->place));
    else first = &part;
  }
}

}  // namespace

void check_skeleton(const Robot& robot, Findings& findings) {
  const auto joints = robot.joints();
  const MovedBy moved_by = check_one_joint_per_body(joints, findings);
  check_loops(joints, moved_by, findings);
  for (const Joint& joint : joints) {
    check_joint(joint, findings);
    check_free(joint, moved_by, findings);
  }
  for (const Body& body : robot.bodies()) check_body(body, moved_by, findings);
  for (const Skeleton& part : robot.skeletons)
    for (const Contact& contact : part.contacts) check_contact(robot, contact, moved_by, findings);
  check_gravity(robot, findings);
}

}  // namespace erp::robot_check
