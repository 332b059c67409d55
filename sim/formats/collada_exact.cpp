#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "interfaces/robot/mass.hpp"
#include "sim/formats/collada.hpp"

namespace formats {
namespace {

constexpr double rounding = 1e-9;  // chosen: for degrees, principal axes and poses in the world

bool same(double a, double b, double scale) { return std::abs(a - b) <= rounding * scale; }

template <std::size_t n>
bool same(const std::array<double, n>& a, const std::array<double, n>& b, double scale) {
  for (std::size_t i = 0; i < n; ++i)
    if (!same(a[i], b[i], scale)) return false;
  return true;
}

xml::Vec3 direction(const xml::Vec3& v) {
  const double length = std::hypot(v[0], v[1], v[2]);
  return length > 0 ? xml::Vec3{v[0] / length, v[1] / length, v[2] / length} : v;
}

[[noreturn]] void refuse(const std::string& what) {
  throw std::invalid_argument(what +
                              ": another program changed the file; remove the <extra> of "
                              "profile ERP to import the skeleton alone");
}

template <class Item>
const Item& named(const std::vector<Item>& items, const std::string& name) {
  const auto found = std::ranges::find(items, name, &Item::name);
  if (found == items.end())
    refuse(std::string(Item::element) + " \"" + name +
           "\" of the extra is missing in the kinematics");
  return *found;
}

template <class Item>
void expect_all(const std::vector<Item>& given, const std::vector<Item>& own) {
  for (const Item& item : given)
    if (std::ranges::find(own, item.name, &Item::name) == own.end())
      refuse(std::string(Item::element) + " \"" + item.name + "\" is not in the extra");
}

void take(erp::Joint& own, const erp::Joint& given) {
  const bool moves =
      given.type != own.type || given.parent != own.parent || given.child != own.child;
  if (moves) own.type = given.type, own.parent = given.parent, own.child = given.child;
  if (!same(own.at_m, given.at_m, 1)) own.at_m = given.at_m;
  if (given.type == erp::JointType::fixed) return;
  if (!same(own.max_rad, given.max_rad, 1)) own.max_rad = given.max_rad;
  if (given.type != erp::JointType::revolute) return;
  if (!same(own.min_rad, given.min_rad, 1)) own.min_rad = given.min_rad;
  if (!same(direction(own.axis), direction(given.axis), 1)) own.axis = given.axis;
}

/// A changed mass replaces the mass of the solids and weights.
void take(erp::Body& own, const erp::Body& given) {
  const erp::Mass own_mass = mass_of(own), given_mass = mass_of(given);
  const double inertia = std::max({given_mass.inertia_kg_m2[0], given_mass.inertia_kg_m2[1],
                                   given_mass.inertia_kg_m2[2], own_mass.inertia_kg_m2[0]});
  if (same(own_mass.mass_kg, given_mass.mass_kg, given_mass.mass_kg + rounding) &&
      same(own_mass.com_m, given_mass.com_m, 1) &&
      same(own_mass.inertia_kg_m2, given_mass.inertia_kg_m2, inertia))
    return;
  own.density_kg_per_m3.reset();
  std::erase_if(own.parts,
                [](const erp::Part& p) { return std::holds_alternative<erp::Weight>(p); });
  own.mass_kg = given.mass_kg, own.com_m = given.com_m;
  own.inertia_kg_m2 = given.inertia_kg_m2, own.products_kg_m2 = given.products_kg_m2;
}

void take_gravity(erp::Robot& robot, const xml::Vec3& given) {
  if (same(robot.gravity_m_per_s2(), given, 10)) return;
  for (erp::Skeleton& skeleton : robot.skeletons) skeleton.gravity_m_per_s2.reset();
  robot.skeletons.front().gravity_m_per_s2 = given;
}

bool moved(const std::vector<erp::Joint>& joints, const std::string& body) {
  return std::ranges::find(joints, body, &erp::Joint::child) != joints.end();
}

}  // namespace

erp::Robot with_skeleton(erp::Robot robot, const erp::Robot& standard) {
  const auto bodies = standard.bodies();
  const auto joints = standard.joints();
  expect_all(bodies, robot.bodies());
  expect_all(joints, robot.joints());
  for (erp::Skeleton& skeleton : robot.skeletons) {
    for (erp::Body& body : skeleton.bodies) {
      const erp::Body& given = named(bodies, body.name);
      if (moved(joints, body.name)) take(body, given);  // the mass of a root is not used
    }
    for (erp::Joint& joint : skeleton.joints) take(joint, named(joints, joint.name));
  }
  take_gravity(robot, standard.gravity_m_per_s2());
  return robot;
}

}  // namespace formats
