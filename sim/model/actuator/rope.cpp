#include "sim/model/actuator/rope.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim/model/actuator/path_line.hpp"

namespace sim {
namespace {

constexpr int max_rope_iterations = 60;      // chosen
constexpr int iterations_with_release = 20;  // chosen: later, contacts are not released
constexpr double step_tolerance_m = 1e-9;    // chosen: step at which the iteration ends
constexpr double accepted_step_m = 1e-5;     // chosen: a larger last step counts as failed
constexpr double max_speed_m_per_s = 100;    // chosen: far above speeds of a real rope
constexpr double max_newton_step_m = 0.02;   // chosen: limit of a node's Newton step
constexpr int max_nodes = 200;               // chosen: limits the time of a step

}  // namespace

Rope::Rope(const erp::Rope& rope, const TendonLaw& law, const Routing& routing,
           std::vector<Solid> solids)
    : ends_{routing.elements().front(), routing.elements().back()},
      law_(law),
      node_kg_(rope.mass_kg / rope.nodes),
      radius_m_(rope.radius_m),
      friction_(rope.friction) {
  if (!(rope.mass_kg > 0)) throw std::invalid_argument("mass_kg of a rope must be positive");
  if (rope.nodes < 2 || rope.nodes > max_nodes)
    throw std::invalid_argument("nodes of a rope must be 2 to " + std::to_string(max_nodes) +
                                ", got " + std::to_string(rope.nodes));
  for (const PathElement& pulley : routing.elements())
    if (pulley.radius_m > 0)
      solids.push_back({pulley.body, pulley.at_m, pulley.at_m, pulley.radius_m});
  for (const Solid& solid : solids)
    if (std::ranges::none_of(ends_, [&](const PathElement& end) {
          return end.body == solid.body && clearance(solid, end.at_m).distance_m < radius_m_;
        }))
      solids_.push_back(solid);
  const auto n = static_cast<std::size_t>(rope.nodes);
  for (auto* points : {&state_.nodes_m, &state_.velocities_m_per_s, &start_m_})
    points->assign(n + 1, Vec3::Zero());
  nodes_.resize(n + 1);
  segments_.resize(n);
  state_.tension_N.assign(n, 0.0);
  state_.forces.reserve(3 * n + 2);
  state_.line_m = law_.rest_m;
}

Vec3 Rope::point(const PathElement& end, std::span<const BodyPose> poses) const {
  const BodyPose& pose = poses[static_cast<std::size_t>(end.body)];
  return pose.position_m + pose.rotation * end.at_m;
}

void Rope::require_fine(double length_m) const {
  double smallest_m = length_m;
  for (const Solid& solid : solids_)
    smallest_m =
        std::min(smallest_m,
                 radius_m_ + (solid.half_m.isZero(0) ? solid.radius_m : solid.half_m.minCoeff()));
  if (length_m / static_cast<double>(segments()) <= smallest_m) return;
  throw std::invalid_argument(
      "a rope of " + std::to_string(length_m) + " m and nodes=" + std::to_string(segments()) +
      " could pass through a solid with a radius or half edge of " + std::to_string(smallest_m) +
      " m; give nodes=" + std::to_string(static_cast<int>(std::ceil(length_m / smallest_m))));
}

void Rope::lay(std::span<const Vec3> line, double shaft_rad) {
  const auto n = segments();
  for (std::size_t i = 0; i <= n; ++i)
    state_.nodes_m[i] = point_on_line(line, static_cast<double>(i) / static_cast<double>(n));
  std::ranges::fill(state_.velocities_m_per_s, Vec3::Zero());
  state_.rest_m = state_.line_m - law_.radius_m * shaft_rad;
  const double tension_N = law_.spring.force_N(length_m() - state_.rest_m);
  std::ranges::fill(state_.tension_N, tension_N);
  for (Node& node : nodes_) node = {};
  update_bone_forces(0);
}

void Rope::settle(std::span<const BodyPose> poses, double shaft_rad,
                  std::optional<double> pretension_N) {
  constexpr int max_steps = 500;    // chosen
  constexpr double step_s = 0.001;  // chosen
  const std::vector<BodyTwist> resting(poses.size());
  for (int k = 0; k < max_steps; ++k) {
    step({poses, resting, Vec3::Zero()}, shaft_rad, step_s);
    if (pretension_N)
      state_.line_m = length_m() - law_.spring.stretch_m(*pretension_N) + law_.radius_m * shaft_rad;
  }
  std::ranges::fill(state_.velocities_m_per_s, Vec3::Zero());
  state_.failed_steps = 0;  // ignores failures while settling
}

void Rope::restore(const RopeState& state) {
  if (state.nodes_m.size() != state_.nodes_m.size() ||
      state.velocities_m_per_s.size() != state_.velocities_m_per_s.size() ||
      state.tension_N.size() != state_.tension_N.size())
    throw std::invalid_argument("the state belongs to a rope with another number of nodes");
  state_ = state;
}

double Rope::length_m() const {
  double length = 0;
  for (std::size_t i = 0; i < segments(); ++i)
    length += (state_.nodes_m[i + 1] - state_.nodes_m[i]).norm();
  return length;
}

void Rope::step(const Surroundings& around, double shaft_rad, double dt_s) {
  begin(around, shaft_rad, dt_s);
  double moved_m = 0;
  bool converged = false;
  for (int iteration = 0; iteration < max_rope_iterations && !converged; ++iteration) {
    touch(around, dt_s, iteration == 0);
    stretch();
    stiffen(dt_s);
    solve();
    moved_m = apply_step();
    converged = moved_m < step_tolerance_m;
    stretch();
    converged = !update_contacts(dt_s, iteration < iterations_with_release) && converged;
  }
  end(around, moved_m < accepted_step_m, dt_s);
}

/// Computes the free motion of the nodes and the linearised law of each segment.
void Rope::begin(const Surroundings& around, double shaft_rad, double dt_s) {
  auto& x = state_.nodes_m;
  const auto n = segments();
  const double segment_count = static_cast<double>(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double stretch = (x[i + 1] - x[i]).norm() - state_.rest_m / segment_count;
    const double tendon_stretch_m = segment_count * stretch;  // if all segments had this stretch
    const double slope = law_.spring.slope_N_per_m(tendon_stretch_m);
    const double force =
        tendon_stretch_m > 0 ? law_.spring.force_N(tendon_stretch_m) : slope * tendon_stretch_m;
    segments_[i].compliance_m_per_N = 1 / (segment_count * (slope + law_.damping_N_s_per_m / dt_s));
    segments_[i].offset_m = stretch - segments_[i].compliance_m_per_N * force;
  }
  state_.rest_m = state_.line_m - law_.radius_m * shaft_rad;
  start_m_ = x;
  for (std::size_t i = 1; i < n; ++i) {
    nodes_[i].contact_count = 0, nodes_[i].drag_kg_per_s = 0;
    nodes_[i].free_m = x[i] + dt_s * state_.velocities_m_per_s[i] + dt_s * dt_s * around.gravity;
  }
  x.front() = point(ends_[0], around.poses), x.back() = point(ends_[1], around.poses);
}

/// Computes tensions and stiffness matrices of the current shape.
void Rope::stretch() {
  const auto& x = state_.nodes_m;
  const double rest = state_.rest_m / static_cast<double>(segments());
  for (std::size_t i = 0; i < segments(); ++i) {
    Segment& s = segments_[i];
    const Vec3 span = x[i + 1] - x[i];
    const double length = span.norm();
    s.along = length > 0 ? Vec3(span / length) : Vec3::UnitZ();
    state_.tension_N[i] = std::max(0.0, (length - rest - s.offset_m) / s.compliance_m_per_N);
    s.stiffness.setZero();
    if (state_.tension_N[i] == 0) continue;
    const Eigen::Matrix3d lengthwise = s.along * s.along.transpose();
    s.stiffness = lengthwise / s.compliance_m_per_N +
                  state_.tension_N[i] / std::max(length, step_tolerance_m) *
                      (Eigen::Matrix3d::Identity() - lengthwise);
  }
}

/// Assembles the Newton system. Nodes in contact move to the surfaces and along them.
void Rope::stiffen(double dt_s) {
  const auto& x = state_.nodes_m;
  const double inertia = node_kg_ / (dt_s * dt_s);
  for (std::size_t i = 1; i < segments(); ++i) {
    Node& node = nodes_[i];
    node.diagonal_block = segments_[i - 1].stiffness + segments_[i].stiffness;
    node.diagonal_block.diagonal().array() += inertia + node.drag_kg_per_s / dt_s;
    node.upper_block = -segments_[i].stiffness;
    node.right_side = tension_force(i) - inertia * (x[i] - node.free_m) -
                      node.drag_kg_per_s / dt_s * (x[i] - node.carried_m);
    stay_outside(node);
  }
  for (std::size_t i = 1; i < segments(); ++i) {
    Node& node = nodes_[i];
    node.right_side -= node.diagonal_block * node.step;
    if (i > 1) node.right_side += segments_[i - 1].stiffness * nodes_[i - 1].step;
    if (i + 1 < segments()) node.right_side += segments_[i].stiffness * nodes_[i + 1].step;
  }
  for (std::size_t i = 1; i < segments(); ++i) {
    Node& node = nodes_[i];
    const Eigen::Matrix3d& p = node.projection;
    node.right_side = p * node.right_side;
    node.diagonal_block = p * node.diagonal_block * p + inertia * (Eigen::Matrix3d::Identity() - p);
    if (i + 1 < segments()) node.upper_block = p * node.upper_block * nodes_[i + 1].projection;
  }
}

/// Solves the symmetric block tridiagonal system.
void Rope::solve() {
  const auto n = segments();
  for (std::size_t i = 1; i < n; ++i) {
    Node& node = nodes_[i];
    if (i > 1) {
      const Node& before = nodes_[i - 1];
      const Eigen::Matrix3d factor =
          before.upper_block.transpose() *
          before.diagonal_block;  // node.diagonal_block is already inverted
      node.right_side -= factor * before.right_side;
      node.diagonal_block -= factor * before.upper_block;
    }
    node.diagonal_block = node.diagonal_block.inverse().eval();
  }
  Vec3 next = Vec3::Zero();
  for (std::size_t i = n - 1; i >= 1; --i) {
    Node& node = nodes_[i];
    next = node.diagonal_block *
           (node.right_side - (i + 1 < n ? Vec3(node.upper_block * next) : Vec3(Vec3::Zero())));
    node.step += next;
  }
}

Vec3 Rope::tension_force(std::size_t node) const {
  return state_.tension_N[node] * segments_[node].along -
         state_.tension_N[node - 1] * segments_[node - 1].along;
}

/// Applies the Newton step, scaled down if the step of a node is too long. Returns the longest
/// step.
double Rope::apply_step() {
  double longest_step_m = 0;
  for (std::size_t i = 1; i < segments(); ++i)
    longest_step_m = std::max(longest_step_m, nodes_[i].step.lpNorm<Eigen::Infinity>());
  const double scale =
      std::min(1.0, max_newton_step_m / std::max(longest_step_m, step_tolerance_m));
  for (std::size_t i = 1; i < segments(); ++i) state_.nodes_m[i] += scale * nodes_[i].step;
  return longest_step_m;
}

void Rope::end(const Surroundings& around, bool converged, double dt_s) {
  double highest_speed_m_per_s = 0;
  for (std::size_t i = 0; i <= segments(); ++i) {
    state_.velocities_m_per_s[i] = (state_.nodes_m[i] - start_m_[i]) / dt_s;
    highest_speed_m_per_s = std::max(highest_speed_m_per_s, state_.velocities_m_per_s[i].norm());
    if (!state_.nodes_m[i].allFinite()) highest_speed_m_per_s = 2 * max_speed_m_per_s;
  }
  const bool diverged = highest_speed_m_per_s > max_speed_m_per_s;
  if (!converged || diverged) ++state_.failed_steps;
  if (!diverged) return update_bone_forces(dt_s);
  const std::array<Vec3, 2> straight{point(ends_[0], around.poses), point(ends_[1], around.poses)};
  lay(straight, (state_.line_m - state_.rest_m) / law_.radius_m);
}

}  // namespace sim
