#pragma once
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "sim/model/actuator/routing.hpp"
#include "sim/model/actuator/solid.hpp"
#include "sim/model/actuator/tendon.hpp"

/// A tendon as a rope that collides with the skeleton: the paper's physical tendon (4.2), whose
/// length is the sum of the distances between its nodes.
///
///   n segments of rest length (L_K + L_R)/n, stiffness n κ and damping n D, in tension only;
///   n − 1 nodes of mass m/n between them, subject to gravity; the ends are fixed to bodies
///
///   x⁺ = argmin Σ_nodes m/n |x − x°|² / 2dt² + Σ_segments ∫ T dC,   x° = x + dt v + dt² g
///   C = |x_i+1 − x_i| − rest,   T = max(0, F(C₋) + (n κ + n D/dt)(C − C₋))      C₋ before the step
///
/// The step is implicit, hence stable for any κ, and convex. It is solved by Newton's method with a
/// block tridiagonal matrix of 3×3 blocks. A node that would enter solids (at most three) slides on
/// their surfaces with regularised Coulomb friction: a drag µ N / max(|v|, v₀). Below v₀ = 0.1 mm/s
/// the rope creeps where it should stick.
///
/// The tension at the ends and the contact force of each node act on the bones with a delay of one
/// step. This is unstable if the line is too stiff for the mass that it moves (κ dt² ≥ m). The
/// watchdog (`failed_steps`) counts the steps in which the solver did not converge or a node moved
/// faster than 100 m/s; the rope is then reset to a straight line.
///
/// Ignores: bending, twist, the rope's thickness except as a distance from solids, other ropes, and
/// contacts between two nodes. The nodes must therefore be dense: see `require_fine`.
namespace sim {

/// A force on a body, at a point; world axes.
struct BodyForce {
  int body = 0;
  Vec3 at_m = Vec3::Zero(), force_N = Vec3::Zero();
};

struct RopeState {
  std::vector<Vec3> nodes_m, velocities_m_per_s;  ///< both ends included
  std::vector<double> tension_N;                  ///< per segment
  std::vector<BodyForce> forces;                  ///< on the bones: at the ends, then at the nodes
  double rest_m = 0;
  double line_m = 0;  ///< L_K0 + L_R, set by `settle` from the pretension
  long failed_steps = 0;
};

/// Environment of a rope: motion of the bodies, and gravity.
struct Surroundings {
  std::span<const BodyPose> poses;
  std::span<const BodyTwist> twists;
  Vec3 gravity = Vec3::Zero();  ///< m/s²
};

class Rope {
 public:
  /// The rope collides with `solids`, except those of an end's own body that contain that end, and
  /// with the pulleys of its path. Throws std::invalid_argument for a mass that is not positive or
  /// a number of nodes outside 2 … 200.
  Rope(const erp::Rope& rope, const TendonLaw& law, const Routing& routing,
       std::vector<Solid> solids);

  /// Throws std::invalid_argument if a rope of that length could pass through a solid, because the
  /// distance of its nodes exceeds the smallest radius or half edge. The message states the
  /// required number of nodes.
  void require_fine(double length_m) const;
  /// Places the rope along a line from end to end, at rest, with the tension of the tendon's law.
  void lay(std::span<const Vec3> line_m, double shaft_rad);
  /// Steps the rope until it rests, with the bodies fixed. With a pretension, it sets the line
  /// length so that the tension at rest equals the pretension.
  void settle(std::span<const BodyPose> poses, double shaft_rad,
              std::optional<double> pretension_N = {});
  /// Advances the rope by dt_s to the new state of the bodies and the shaft. No heap.
  void step(const Surroundings& around, double shaft_rad, double dt_s);

  double length_m() const;
  double tension_N() const { return state_.tension_N.front(); }  ///< at the motor's end
  std::span<const BodyForce> forces() const { return state_.forces; }
  std::span<const Vec3> nodes_m() const { return state_.nodes_m; }
  long failed_steps() const { return state_.failed_steps; }

  const RopeState& state() const { return state_; }
  /// Throws std::invalid_argument if the state has another number of nodes.
  void restore(const RopeState& state);

 private:
  /// Contact of a node with a solid.
  struct Touch {
    const Solid* solid = nullptr;
    Vec3 normal = Vec3::Zero();
    double distance_m = 0;  ///< from the surface; negative: inside
    double push_N = 0;
  };
  /// Working data of a node during a step.
  struct Node {
    Vec3 free_m = Vec3::Zero();     ///< x°
    Vec3 carried_m = Vec3::Zero();  ///< position if it moved with the solid it touches
    double drag_kg_per_s = 0;
    std::array<Touch, 3> touches;
    std::size_t contact_count = 0;                             ///< number of contacts
    Eigen::Matrix3d projection = Eigen::Matrix3d::Identity();  ///< projection onto the surfaces
    // a row of Newton's system: diagonal_block Δx + upper_block Δx_next = right_side
    Eigen::Matrix3d diagonal_block = Eigen::Matrix3d::Zero(), upper_block = Eigen::Matrix3d::Zero();
    Vec3 right_side = Vec3::Zero(), step = Vec3::Zero();
    std::span<Touch> touching() { return {touches.data(), contact_count}; }
    std::span<const Touch> touching() const { return {touches.data(), contact_count}; }
  };
  struct Segment {
    double compliance_m_per_N, offset_m;  ///< T = (C − offset) / compliance
    Vec3 along;
    Eigen::Matrix3d stiffness;
  };
  std::size_t segments() const { return segments_.size(); }
  Vec3 point(const PathElement& end, std::span<const BodyPose> poses) const;
  void begin(const Surroundings& around, double shaft_rad, double dt_s);
  void touch(const Surroundings& around, double dt_s, bool at_start);
  void touch(Node& node, const Vec3& at, std::span<const BodyPose> poses,
             double new_contact_m) const;
  static void stay_outside(Node& node);
  void stretch();
  void stiffen(double dt_s);
  void solve();
  Vec3 tension_force(std::size_t node) const;
  double apply_step();
  Vec3 contact_force(std::size_t node, double dt_s) const;
  static double distribute_contact_force(Node& node, const Vec3& force_N);
  bool update_contacts(double dt_s, bool may_release);
  void end(const Surroundings& around, bool converged, double dt_s);
  void update_bone_forces(double dt_s);

  std::array<PathElement, 2> ends_;
  std::vector<Solid> solids_;
  TendonLaw law_;
  double node_kg_, radius_m_, friction_;
  RopeState state_;
  // working memory of a step
  std::vector<Node> nodes_;
  std::vector<Segment> segments_;
  std::vector<Vec3> start_m_;
};

}  // namespace sim
