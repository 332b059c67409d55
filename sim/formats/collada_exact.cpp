#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "interfaces/robot/mass.hpp"
#include "sim/formats/collada.hpp"

namespace formats {
namespace {

constexpr double rounding = 1e-9;  // chosen: for degrees, principal axes and poses in the world

bool nearly_equal(double a, double b, double scale) { return std::abs(a - b) <= rounding * scale; }

template <std::size_t n>
bool nearly_equal(const std::array<double, n>& a, const std::array<double, n>& b, double scale) {
  for (std::size_t i = 0; i < n; ++i)
    if (!nearly_equal(a[i], b[i], scale)) return false;
  return true;
}

xml::Vec3 direction(const xml::Vec3& v) {
  const double length = std::hypot(v[0], v[1], v[2]);
  return length > 0 ? xml::Vec3{v[0] / length, v[1] / length, v[2] / length} : v;
}

[[noreturn]] void reject(const std::string& what) {
  throw std::invalid_argument(what +
                              ": another program changed the file; remove the <extra> of "
                              "profile ERP to import the skeleton alone");
}

template <class Item>
const Item& item_named(const std::vector<Item>& items, const std::string& name) {
  const auto match = std::ranges::find(items, name, &Item::name);
  if (match == items.end())
    reject(std::string(Item::element) + " \"" + name +
           "\" of the extra is missing in the kinematics");
  return *match;
}

template <class Item>
void expect_all(const std::vector<Item>& standard, const std::vector<Item>& exact) {
  for (const Item& item : standard)
    if (std::ranges::find(exact, item.name, &Item::name) == exact.end())
      reject(std::string(Item::element) + " \"" + item.name + "\" is not in the extra");
}

void merge(erp::Joint& exact, const erp::Joint& standard) {
  const bool is_moved = standard.type != exact.type || standard.parent != exact.parent ||
                        standard.child != exact.child;
  if (is_moved)
    exact.type = standard.type, exact.parent = standard.parent, exact.child = standard.child;
  if (!nearly_equal(exact.at_m, standard.at_m, 1)) exact.at_m = standard.at_m;
  if (standard.type == erp::JointType::fixed) return;
  if (!nearly_equal(exact.max_rad, standard.max_rad, 1)) exact.max_rad = standard.max_rad;
  if (standard.type != erp::JointType::revolute) return;
  if (!nearly_equal(exact.min_rad, standard.min_rad, 1)) exact.min_rad = standard.min_rad;
  if (!nearly_equal(direction(exact.axis), direction(standard.axis), 1)) exact.axis = standard.axis;
}

/// A changed mass replaces the mass of the solids and weights.
void merge(erp::Body& exact, const erp::Body& standard) {
  const erp::Mass exact_mass = mass_of(exact), standard_mass = mass_of(standard);
  const double inertia = std::max({standard_mass.inertia_kg_m2[0], standard_mass.inertia_kg_m2[1],
                                   standard_mass.inertia_kg_m2[2], exact_mass.inertia_kg_m2[0]});
  if (nearly_equal(exact_mass.mass_kg, standard_mass.mass_kg, standard_mass.mass_kg + rounding) &&
      nearly_equal(exact_mass.com_m, standard_mass.com_m, 1) &&
      nearly_equal(exact_mass.inertia_kg_m2, standard_mass.inertia_kg_m2, inertia))
    return;
  exact.density_kg_per_m3.reset();
  std::erase_if(exact.parts,
                [](const erp::Part& p) { return std::holds_alternative<erp::Weight>(p); });
  exact.mass_kg = standard.mass_kg, exact.com_m = standard.com_m;
  exact.inertia_kg_m2 = standard.inertia_kg_m2, exact.products_kg_m2 = standard.products_kg_m2;
}

void merge_gravity(erp::Robot& robot, const xml::Vec3& standard) {
  if (nearly_equal(robot.gravity_m_per_s2(), standard, 10)) return;
  for (erp::Skeleton& skeleton : robot.skeletons) skeleton.gravity_m_per_s2.reset();
  robot.skeletons.front().gravity_m_per_s2 = standard;
}

bool has_joint(const std::vector<erp::Joint>& joints, const std::string& body) {
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
      const erp::Body& standard_body = item_named(bodies, body.name);
      if (has_joint(joints, body.name))
        merge(body, standard_body);  // the mass of a root is not used
    }
    for (erp::Joint& joint : skeleton.joints) merge(joint, item_named(joints, joint.name));
  }
  merge_gravity(robot, standard.gravity_m_per_s2());
  return robot;
}

}  // namespace formats
