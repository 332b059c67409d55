#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "interfaces/robot/robot.hpp"
#include "sim/model/actuator/musculoskeletal.hpp"
#include "sim/model/actuator/tendon.hpp"
#include "sim/model/skeleton/joint_path.hpp"

/// The zeros of encoders from measurements of a robot that stands still or moves slowly.
///
///   l_a(q_k) = rest_a + line_ak + o_a + Δx_a(F_ak)       paper, eqs 1, 2, 4, without damping
///
/// Snapshot k has measured lines and tensions F; the pose q_k is unknown, except for joints with a
/// sensor. o_a, the offset of a line whose zero is unknown, is the same in all snapshots. Least squares
/// over all o_a and q_k, by Gauss–Newton with Levenberg–Marquardt damping:
///
///   Σ (l_a − rest_a − line_ak − o_a − Δx_a)²/σ_l² + Σ (q_k − sensor)²/σ_s² + Σ (q_k ⊖ start_k)²/σ_p²
///
/// One snapshot is sufficient if all joints have sensors, or if the zeros of enough other lines are
/// known. Otherwise the robot must move: moment arms change with the pose, so only the true offsets fit
/// all snapshots. start_k comes from a simulation with the same tensions. Source of σ: chosen.
namespace sim {

/// Measurements at one moment.
struct HomingSnapshot {
  std::vector<double> line_m, tension_N;         ///< by actuator; line: change as counted
  std::vector<std::optional<double>> joint_rad;  ///< by joint sensor; none: no valid reading
};

struct HomedLines {
  std::vector<double> offset_m;  ///< o_a by actuator; 0 where the zero is known
  std::vector<double> sigma_m;   ///< their standard deviations
};

class HomingEstimate {
 public:
  /// Throws like Musculoskeletal.
  explicit HomingEstimate(const erp::Robot& robot);

  /// Names of the joints that sensors do not measure completely.
  const std::vector<std::string>& unmeasured() const { return unmeasured_; }

  /// Simulates the robot from its starting pose: tensions in N by actuator, reached within `ramp_s` and
  /// then held until `each_s`, one set after the other. Returns the pose at the end of each.
  /// Throws NotFinite.
  std::vector<Pose> simulate(std::span<const std::vector<double>> tension_N, double ramp_s,
                             double each_s) const;

  /// `known`: whether the zero of each actuator is known. `start`: one pose per snapshot.
  HomedLines find(std::span<const HomingSnapshot> snapshots, const std::vector<bool>& known,
                  std::vector<Pose> start);

 private:
  struct Problem;
  void set_measured(Pose& pose, const HomingSnapshot& snapshot, const Pose& starting) const;
  double linearize(Problem& problem, std::span<const Pose> poses, const Eigen::VectorXd& offset_m);
  std::vector<Pose> moved(std::span<const Pose> poses, const Eigen::VectorXd& step) const;

  erp::Robot robot_;
  Musculoskeletal model_;
  std::vector<TendonLaw> laws_;
  std::vector<bool> measured_;  ///< by joint
  std::vector<std::string> unmeasured_;
};

}  // namespace sim
