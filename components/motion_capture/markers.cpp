#include "components/motion_capture/markers.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <set>

namespace capture {

using sim::BodyPose;
using sim::Vec3;

std::vector<Marker> markers_of(std::span<const MarkerConfig> configs, const sim::RobotTree& tree) {
  std::vector<Marker> markers;
  for (const MarkerConfig& config : configs)
    markers.push_back({sim::body_named(tree.names, config.body, "a marker"),
                       {config.at_m[0], config.at_m[1], config.at_m[2]}});
  return markers;
}

MarkerPoints assign_nearest(std::span<const Marker> markers, std::span<const BodyPose> expected,
                            std::span<const StereoPoint> points, double gate_m) {
  struct Pair {
    double distance_m;
    std::size_t marker, point;
  };
  std::vector<Pair> pairs;
  for (std::size_t m = 0; m < markers.size(); ++m) {
    const BodyPose& body = expected[markers[m].body];
    const Vec3 predicted_m = body.position_m + body.rotation * markers[m].at_m;
    for (std::size_t p = 0; p < points.size(); ++p)
      if (const double distance_m = (points[p].at_m - predicted_m).norm(); distance_m < gate_m)
        pairs.push_back({distance_m, m, p});
  }
  std::ranges::sort(pairs, {}, &Pair::distance_m);
  MarkerPoints measured(markers.size());
  std::set<std::size_t> left, right;  // spots already assigned
  for (const Pair& pair : pairs) {
    const StereoPoint& point = points[pair.point];
    if (measured[pair.marker] || left.contains(point.left) || right.contains(point.right)) continue;
    measured[pair.marker] = point.at_m;
    left.insert(point.left), right.insert(point.right);
  }
  return measured;
}

BodyPose rigid_pose(std::span<const Vec3> in_body_m, std::span<const Vec3> seen_m) {
  Eigen::Matrix3Xd from(3, in_body_m.size()), to(3, seen_m.size());
  for (std::size_t k = 0; k < in_body_m.size(); ++k)
    from.col(static_cast<Eigen::Index>(k)) = in_body_m[k],
    to.col(static_cast<Eigen::Index>(k)) = seen_m[k];
  const Eigen::Matrix4d transform = Eigen::umeyama(from, to, false);
  return {transform.topLeftCorner<3, 3>(), transform.topRightCorner<3, 1>()};
}

namespace {

/// Exhaustive search of a body's markers among the points.
class Search {
 public:
  Search(std::span<const Vec3> in_body_m, std::span<const StereoPoint> points, double tolerance_m)
      : body_(in_body_m), points_(points), tolerance_m_(tolerance_m) {}

  std::optional<BodyPose> find() {
    for (std::size_t i = 0; i + 2 < body_.size(); ++i)
      for (std::size_t j = i + 1; j + 1 < body_.size(); ++j)
        for (std::size_t k = j + 1; k < body_.size(); ++k) try_triple({i, j, k});
    return best_pose_;
  }

 private:
  bool fits(std::size_t a, std::size_t b, std::size_t p, std::size_t q) const {
    return std::abs((body_[a] - body_[b]).norm() - (points_[p].at_m - points_[q].at_m).norm()) <
           2 * tolerance_m_;
  }
  void try_triple(const std::array<std::size_t, 3>& m) {
    for (std::size_t p = 0; p < points_.size(); ++p)
      for (std::size_t q = 0; q < points_.size(); ++q)
        if (q != p && fits(m[0], m[1], p, q))
          for (std::size_t r = 0; r < points_.size(); ++r)
            if (r != p && r != q && fits(m[0], m[2], p, r) && fits(m[1], m[2], q, r))
              try_pose({body_[m[0]], body_[m[1]], body_[m[2]]},
                       {points_[p].at_m, points_[q].at_m, points_[r].at_m});
  }
  void try_pose(const std::array<Vec3, 3>& from, const std::array<Vec3, 3>& to) {
    const BodyPose pose = rigid_pose(from, to);
    std::size_t matched = 0;
    double distance_sum_m = 0;
    for (const Vec3& marker : body_) {
      double nearest_m = tolerance_m_;
      for (const StereoPoint& point : points_)
        nearest_m =
            std::min(nearest_m, (pose.position_m + pose.rotation * marker - point.at_m).norm());
      matched += nearest_m < tolerance_m_;
      distance_sum_m += nearest_m;
    }
    if (matched < 3 || matched < most_matched_ ||
        (matched == most_matched_ && distance_sum_m >= smallest_sum_m_))
      return;
    most_matched_ = matched, smallest_sum_m_ = distance_sum_m, best_pose_ = pose;
  }

  std::span<const Vec3> body_;
  std::span<const StereoPoint> points_;
  double tolerance_m_;
  std::size_t most_matched_ = 0;
  double smallest_sum_m_ = 0;
  std::optional<BodyPose> best_pose_;
};

}  // namespace

std::optional<BodyPose> find_body(std::span<const Vec3> in_body_m,
                                  std::span<const StereoPoint> points, double tolerance_m) {
  return Search(in_body_m, points, tolerance_m).find();
}

}  // namespace capture
