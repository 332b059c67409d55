#pragma once
#include <Eigen/Core>
#include <array>
#include <span>
#include <string>
#include <vector>

#include "interfaces/robot/robot.hpp"
#include "sim/model/actuator/pulley_wrap.hpp"
#include "sim/model/skeleton/pose.hpp"

/// A tendon's path over the bodies: points that it passes through and pulleys that it may wrap around.
///
///   L = Σ free spans + Σ r · wrapped angle
///   force on the body at element k:  F (û_before + û_after)     (unit vectors along the spans)
///   dL/dt = − Σ (û_before + û_after) · v_k
///
/// Forces act at the points and at the pulleys' centres, sum to zero, and their power is −F dL/dt.
/// A frictionless sphere takes no moment, a cylinder none about its axis. A line with a component along
/// the cylinder's axis exerts the moment of the pulls at its entry and exit points. Several pulleys
/// between two points are solved iteratively, one after the other, until the path converges.
namespace sim {

inline constexpr int max_path_elements = 12;

/// A point (radius 0) or a pulley, fixed to a body.
struct PathElement {
  int body = 0;
  Vec3 at_m = Vec3::Zero();
  double radius_m = 0;
  Vec3 side = Vec3::Zero(), axis = Vec3::Zero();  ///< axis zero: no axis
  bool cylinder = false;
  int turns = 0;
};

/// The pull on one element's body, for 1 N of tension; world axes.
struct PathPull {
  int body = 0;
  Vec3 at_m, direction;  ///< direction = û_before + û_after; zero without contact
  Vec3 moment_m;         ///< about at_m; non-zero only for cylinders
};

/// A path's shape at one pose.
struct PathShape {
  double length_m = 0;
  int elements = 0;
  std::array<Vec3, max_path_elements> entry_m, exit_m;  ///< world; equal for a point
  std::array<Vec3, max_path_elements> about;            ///< axis of the wrap around a pulley
  std::array<double, max_path_elements> wrapped_rad{}, wrapped_m{};
  /// φ of pulleys with an axis; the next shape counts turns relative to this value.
  std::array<double, max_path_elements> around_rad{};
  std::array<bool, max_path_elements> touches{};
  std::array<bool, max_path_elements>
      inside{};  ///< a point is inside this pulley, which is then ignored
  std::array<PathPull, max_path_elements> pulls;
  /// The first pulley that contains a neighbouring point; −1: none.
  int penetrated_pulley() const;
  std::span<const PathPull> pulled() const { return {pulls.data(), std::size_t(elements)}; }
};

class Routing {
 public:
  /// `body_names` defines the bodies' indices. Throws std::invalid_argument for fewer than two points,
  /// an end that is not a point, an unknown body, too many elements, or a pulley without radius.
  Routing(const erp::Tendon& tendon, std::span<const std::string> body_names);

  /// The first shape: all pulleys with their initial number of turns.
  PathShape solve(std::span<const BodyPose> poses) const;
  /// The next shape; turns are counted from the previous one in `shape`.
  void solve(std::span<const BodyPose> poses, PathShape& shape) const;
  /// Throws std::invalid_argument if a point lies inside a pulley in this pose.
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

/// Total bend angle of the path, around its pulleys and at its points.
double bend_rad(const PathShape& shape);

/// dL/dt at this shape.
double length_rate_m_per_s(const PathShape& shape, std::span<const BodyPose> poses,
                           std::span<const BodyTwist> twists);

}  // namespace sim
