#include "sim/world/contacts.hpp"

#include <algorithm>

#include "sim/world/bullet_headers.hpp"

namespace sim {
namespace {

constexpr double near_m = 0.01;          // chosen: 1 ms of motion at 10 m/s
constexpr double max_rounding_m = 1e-3;  // chosen: radius of the edges of a box
constexpr double edge_per_rounding = 5;  // chosen: half the shortest edge over this radius

/// All points within `radius` of a core; Bullet calls the radius the margin.
struct Hull {
  std::unique_ptr<btConvexShape> shape;
  btTransform in_body;
  double radius = 0;
  double reach = 0;  ///< largest distance of the core from the solid's centre
};

Hull hull_of(const erp::Sphere& s) {
  return {std::make_unique<btSphereShape>(s.radius_m),
          btTransform(btQuaternion::getIdentity(), bt(s.at_m)), s.radius_m, 0};
}

Hull hull_of(const erp::Capsule& c) {
  const btVector3 from = bt(c.from_m), to = bt(c.to_m);
  const double length = from.distance(to);
  const btVector3 along = length > 0 ? (to - from) / length : btVector3(0, 0, 1);
  const btQuaternion rotation = shortestArcQuat(btVector3(0, 0, 1), along);
  return {std::make_unique<btCapsuleShapeZ>(c.radius_m, length),
          btTransform(rotation, (from + to) / 2), c.radius_m, length / 2};
}

Hull hull_of(const erp::Box& b) {
  const btVector3 half = bt(b.size_m) / 2;
  const double radius = std::min(max_rounding_m, half[half.minAxis()] / edge_per_rounding);
  auto shape = std::make_unique<btBoxShape>(half);
  shape->setMargin(radius);
  return {std::move(shape), btTransform(btQuaternion::getIdentity(), bt(b.at_m)), radius,
          half.length()};
}

std::vector<Hull> hulls_of(const erp::Body& body) {
  std::vector<Hull> solids;
  for (const erp::Part& part : body.parts)
    std::visit(
        [&](const auto& p) {
          if constexpr (requires { hull_of(p); }) solids.push_back(hull_of(p));
        },
        part);
  return solids;
}

/// The nearest points of two solids.
struct Touch {
  double gap_m;
  btVector3 normal;  ///< from b to a
  btVector3 at;      ///< on a's surface
};

/// Bullet gives its normal in the first solid's frame; the two points are in the world.
Touch nearest_points(const Hull& a, const btTransform& at_a, const Hull& b,
                     const btTransform& at_b) {
  btGjkEpaSolver2::sResults result;
  const btVector3 guess = at_a.getOrigin() - at_b.getOrigin();
  const bool are_separate =
      btGjkEpaSolver2::Distance(a.shape.get(), at_a, b.shape.get(), at_b, guess, result);
  // If the cores overlap, a's deepest point lies inside b.
  if (!are_separate)
    btGjkEpaSolver2::Penetration(a.shape.get(), at_a, b.shape.get(), at_b, guess, result, true);
  const btVector3 between = (result.witnesses[0] - result.witnesses[1]) * (are_separate ? 1 : -1);
  const double length = between.length();
  const btVector3 normal = length > 0 ? between / length : btVector3(0, 0, 1);
  if (are_separate)
    return {length - a.radius - b.radius, normal, result.witnesses[0] - a.radius * normal};
  return {-length, normal, result.witnesses[0]};
}

}  // namespace

struct Contacts::Solids {
  struct Pair {
    int a, b;        ///< bodies
    double mass_kg;  ///< of the lighter moving body
    const Hull *solid_a, *solid_b;
  };
  std::vector<std::vector<Hull>> of_body;
  std::vector<Pair> pairs;

  static btTransform in_world(const Hull& solid, const BodyPose& pose) {
    const Eigen::Matrix3d& r = pose.rotation;
    const btMatrix3x3 rotation(r(0, 0), r(0, 1), r(0, 2), r(1, 0), r(1, 1), r(1, 2), r(2, 0),
                               r(2, 1), r(2, 2));
    return btTransform(rotation, bt(pose.position_m)) * solid.in_body;
  }
};

Contacts::Contacts(const RobotTree& tree, const erp::Robot& robot)
    : solids_(std::make_unique<Solids>()) {
  for (const TreeBody& body : tree.bodies) solids_->of_body.push_back(hulls_of(body.body));
  const auto index = [&](const std::string& name) {
    return static_cast<int>(std::ranges::find(tree.names, name) - tree.names.begin());
  };
  for (const erp::Skeleton& part : robot.skeletons)
    for (const erp::Contact& contact : part.contacts) {
      const int a = index(contact.body), b = index(contact.on);
      const double m_a = tree.bodies[a].mass.mass_kg, m_b = tree.bodies[b].mass.mass_kg;
      const double lighter = m_a > 0 && m_b > 0 ? std::min(m_a, m_b) : std::max(m_a, m_b);
      for (const Hull& solid_a : solids_->of_body[a])
        for (const Hull& solid_b : solids_->of_body[b])
          solids_->pairs.push_back({a, b, lighter, &solid_a, &solid_b});
    }
}

Contacts::~Contacts() = default;

int Contacts::max_count() const { return static_cast<int>(solids_->pairs.size()); }

namespace {

/// The row −n·(v_a − v_b) over the coordinates that move either body.
void set_approach_row(const Touch& t, int a, int b, const SkeletonModel& model,
                      std::vector<OneSidedForce::Term>& row) {
  const btVector3& n = t.normal;
  const Vec6 approach = wrench({t.at[0], t.at[1], t.at[2]}, {-n[0], -n[1], -n[2]});
  row.clear();
  for (const int d : model.movers(a)) row.push_back({d, model.axis(d).dot(approach)});
  for (const int d : model.movers(b)) {
    const double slope = -model.axis(d).dot(approach);
    const auto common = std::ranges::find(row, d, &OneSidedForce::Term::coordinate);
    if (common == row.end()) row.push_back({d, slope});
    else common->slope += slope;
  }
}

}  // namespace

int Contacts::find(const SkeletonModel& model, double dt, std::span<OneSidedForce> forces) const {
  int count = 0;
  for (const Solids::Pair& pair : solids_->pairs) {
    const Hull &a = *pair.solid_a, &b = *pair.solid_b;
    const btTransform at_a = Solids::in_world(a, model.poses()[pair.a]);
    const btTransform at_b = Solids::in_world(b, model.poses()[pair.b]);
    const double reach = a.reach + a.radius + b.reach + b.radius + near_m;
    if (at_a.getOrigin().distance2(at_b.getOrigin()) > reach * reach) continue;
    const Touch t = nearest_points(a, at_a, b, at_b);
    if (t.gap_m > near_m) continue;
    OneSidedForce& force = forces[count++];
    set_stop(t.gap_m, pair.mass_kg, dt, force);
    set_approach_row(t, pair.a, pair.b, model, force.row);
  }
  return count;
}

}  // namespace sim
