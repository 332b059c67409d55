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
///   n segments of rest length (L_K + L_R)/n, stiffness n κ, damping n D, which only pull; between
///   them n − 1 nodes of mass m/n with weight; its ends are fixed to bodies
///
///   x⁺ = argmin Σ_nodes m/n |x − x°|² / 2dt² + Σ_segments ∫ T dC,   x° = x + dt v + dt² g
///   C = |x_i+1 − x_i| − rest,   T = max(0, F(C₋) + (n κ + n D/dt)(C − C₋))      C₋ before the step
///
/// implicit, stable for any κ; convex, solved by Newton's method, whose matrix has 3×3 blocks on
/// three diagonals. A node that would enter a solid, or up to three, slides on their surfaces, with
/// Coulomb's friction, regularised: a drag µ N / max(|v|, v₀), so that below v₀ = 0.1 mm/s a rope
/// that should stick creeps.
///
/// The bones feel the pull at its ends and the reaction of each node that touches, both a step
/// late: with lines stiffer than what they hold is heavy (κ dt² ≥ m) that is unstable. The watchdog
/// (`troubles`) counts the steps at which the nodes did not come to rest or ran away, faster than
/// 100 m/s; then the rope is laid anew, straight.
///
/// Ignores: bending, twist, the rope's thickness but as a distance from solids, other ropes; and
/// what lies between two nodes, so they must be near each other: see `require_fine`.
namespace sim {

/// A force on a body, at a point; world axes.
struct BodyForce {
  int body = 0;
  Vec3 at_m = Vec3::Zero(), force_N = Vec3::Zero();
};

struct RopeState {
  std::vector<Vec3> nodes_m, velocities_m_per_s;  ///< both ends included
  std::vector<double> tension_N;                  ///< of each segment
  std::vector<BodyForce> forces;                  ///< on the bones: the ends, then the nodes
  double rest_m = 0;
  double line_m = 0;  ///< L_K0 + L_R: settled with its pretension
  long troubles = 0;
};

/// What a rope lies on and hangs in.
struct Surroundings {
  std::span<const BodyPose> poses;
  std::span<const BodyTwist> twists;
  Vec3 gravity = Vec3::Zero();  ///< m/s²
};

class Rope {
 public:
  /// The solids it may touch: all but those of an end's own body that hold that end in their
  /// inside; and the pulleys of its path. Throws std::invalid_argument for a mass that is not
  /// positive or a number of nodes out of 2 … 200.
  Rope(const erp::Rope& rope, const TendonLaw& law, const Routing& routing,
       std::vector<Solid> solids);

  /// Throws std::invalid_argument if a rope of that length could step over a solid: its nodes stand
  /// farther apart than the smallest radius or half edge. Says how many nodes it needs.
  void require_fine(double length_m) const;
  /// Laid along a line from end to end, at rest, with the tension the tendon's law gives.
  void lay(std::span<const Vec3> line_m, double shaft_rad);
  /// Lets it come to rest among still bodies; with a pretension, its line becomes so long that it
  /// then pulls with that.
  void settle(std::span<const BodyPose> poses, double shaft_rad,
              std::optional<double> pretension_N = {});
  /// The bodies have moved there, and the shaft. No heap.
  void step(const Surroundings& around, double shaft_rad, double dt_s);

  double length_m() const;
  double tension_N() const { return state_.tension_N.front(); }  ///< at the motor's end
  std::span<const BodyForce> forces() const { return state_.forces; }
  std::span<const Vec3> nodes_m() const { return state_.nodes_m; }
  long troubles() const { return state_.troubles; }

  const RopeState& state() const { return state_; }
  /// Throws std::invalid_argument for the state of a rope of another size.
  void restore(const RopeState& state);

 private:
  /// A solid that a node lies on.
  struct Touch {
    const Solid* solid = nullptr;
    Vec3 normal = Vec3::Zero();
    double above_m = 0;  ///< of its surface; negative: inside
    double push_N = 0;
  };
  /// A node in the step.
  struct Node {
    Vec3 free_m = Vec3::Zero();     ///< x°
    Vec3 carried_m = Vec3::Zero();  ///< where the solid it is on would carry it
    double drag_kg_per_s = 0;
    std::array<Touch, 3> touches;
    std::size_t on = 0;                                    ///< how many of them
    Eigen::Matrix3d across = Eigen::Matrix3d::Identity();  ///< takes away what leads off them
    // a row of Newton's system: own Δx + after Δx_next = right
    Eigen::Matrix3d own = Eigen::Matrix3d::Zero(), after = Eigen::Matrix3d::Zero();
    Vec3 right = Vec3::Zero(), step = Vec3::Zero();
    std::span<Touch> touching() { return {touches.data(), on}; }
    std::span<const Touch> touching() const { return {touches.data(), on}; }
  };
  struct Segment {
    double give_m_per_N, kept_m;  ///< T = (C − kept) / give
    Vec3 along;
    Eigen::Matrix3d stiffness;
  };
  std::size_t segments() const { return segments_.size(); }
  Vec3 point(const PathElement& end, std::span<const BodyPose> poses) const;
  void begin(const Surroundings& around, double shaft_rad, double dt_s);
  void touch(const Surroundings& around, double dt_s, bool at_start);
  void touch(Node& node, const Vec3& at, std::span<const BodyPose> poses, double nearer_m) const;
  static void stay_outside(Node& node);
  void stretch();
  void stiffen(double dt_s);
  void solve();
  Vec3 pull_on(std::size_t node) const;
  double go();
  Vec3 held_by_solids(std::size_t node, double dt_s) const;
  static double press(Node& node, const Vec3& held);
  bool rub(double dt_s, bool may_leave);
  void end(const Surroundings& around, bool rests, double dt_s);
  void balance(double dt_s);

  std::array<PathElement, 2> ends_;
  std::vector<Solid> solids_;
  TendonLaw law_;
  double node_kg_, radius_m_, friction_;
  RopeState state_;
  // what a step works with
  std::vector<Node> nodes_;
  std::vector<Segment> segments_;
  std::vector<Vec3> start_m_;
};

}  // namespace sim
