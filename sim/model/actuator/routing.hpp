#pragma once
#include <Eigen/Core>
#include <array>
#include <span>
#include <string>
#include <vector>

#include "interfaces/robot/robot.hpp"
#include "sim/model/actuator/pulley_wrap.hpp"
#include "sim/model/skeleton/pose.hpp"

/// A tendon's path over the bodies: points it passes and pulleys it may wrap around.
///
///   L = Σ free spans + Σ r · wrapped angle
///   force on the body at element k:  F (û_before + û_after)     (unit vectors along the spans)
///   dL/dt = − Σ (û_before + û_after) · v_k
///
/// Forces act at the points and at the pulleys' centres, sum to zero, and their power is −F dL/dt.
/// A frictionless sphere takes no moment, a cylinder none about its axis; where a line runs along
/// it, it takes the moment of the pulls where the line comes and leaves. Several pulleys between
/// two points are solved one after the other, in turns, until the path rests.
namespace sim {

inline constexpr int max_path_elements = 12;

/// A point (radius 0) or a pulley, fixed to a body.
struct PathElement {
  int body = 0;
  Vec3 at_m = Vec3::Zero();
  double radius_m = 0;
  Vec3 side = Vec3::Zero(), axis = Vec3::Zero();  ///< axis zero: none
  bool cylinder = false;
  int turns = 0;
};

/// The pull on one element's body, for 1 N of tension; world axes.
struct PathPull {
  int body = 0;
  Vec3 at_m, direction;  ///< direction = û_before + û_after; zero where the line does not touch
  Vec3 moment_m;         ///< about that point; of cylinders only
};

/// A path's shape at one pose.
struct PathShape {
  double length_m = 0;
  int elements = 0;
  std::array<Vec3, max_path_elements> entry_m, exit_m;  ///< world; equal for a point
  std::array<Vec3, max_path_elements> about;            ///< axis of the way around a pulley
  std::array<double, max_path_elements> wrapped_rad{}, wrapped_m{};
  /// φ of pulleys with an axis; the next shape counts their turns from here.
  std::array<double, max_path_elements> around_rad{};
  std::array<bool, max_path_elements> touches{};
  std::array<bool, max_path_elements> inside{};  ///< a point is inside this pulley: it is passed by
  std::array<PathPull, max_path_elements> pulls;
  /// The first pulley that a neighbouring point is inside of; −1: none.
  int pierced() const;
  std::span<const PathPull> pulled() const { return {pulls.data(), std::size_t(elements)}; }
};

class Routing {
 public:
  /// `body_names` gives the bodies' indices. Throws std::invalid_argument: fewer than two points,
  /// an end that is no point, an unknown body, too many elements, a pulley without radius.
  Routing(const erp::Tendon& tendon, std::span<const std::string> body_names);

  /// The first shape: all pulleys with the turns they start with.
  PathShape solve(std::span<const BodyPose> poses) const;
  /// The next one, from the one before: turns are counted.
  void solve(std::span<const BodyPose> poses, PathShape& shape) const;
  /// Throws std::invalid_argument if at this pose a point lies inside a pulley.
  void require_outside(std::span<const BodyPose> poses) const;
  std::span<const PathElement> elements() const { return elements_; }

 private:
  void place(PathShape& shape, std::span<const BodyPose> poses) const;
  void wrap_between(PathShape& shape, std::span<const BodyPose> poses,
                    std::span<const double> last_rad, int first, int last) const;
  double wrap_one(PathShape& shape, std::span<const BodyPose> poses, double last_rad, int k) const;
  void pull(PathShape& shape) const;

  std::vector<PathElement> elements_;
};

/// How far the path turns: around its pulleys and at its points.
double bend_rad(const PathShape& shape);

/// dL/dt at this shape.
double length_rate_m_per_s(const PathShape& shape, std::span<const BodyPose> poses,
                           std::span<const BodyTwist> twists);

}  // namespace sim
