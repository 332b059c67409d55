#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "interfaces/robot/robot.hpp"
#include "interfaces/topics.hpp"
#include "sim/model/skeleton/catch_up.hpp"
#include "sim/model/skeleton/joint_path.hpp"
#include "sim/model/skeleton/skeleton_model.hpp"

/// Joints of a robot in its own order, from and to messages that identify them by name.
namespace joints {

class Names {
 public:
  explicit Names(const erp::Robot& robot);

  std::size_t size() const { return joints_.size(); }
  std::span<const erp::Joint> list() const { return joints_; }

  /// False, with undefined output, if a movable joint is missing from the message or is not finite.
  bool read(const erp::JointState& message, std::vector<sim::JointReading>& readings) const;
  bool read(const erp::JointTarget& message, std::vector<sim::JointMotion>& motions) const;
  /// The same, extrapolated to `at_ns` with the message's velocity, q ⊕ v dt. Not extrapolated
  /// beyond 50 ms, because the clocks of computers may differ.
  bool read(const erp::JointState& message, std::int64_t at_ns,
            std::vector<sim::JointReading>& readings) const;
  bool read(const erp::JointTarget& message, std::int64_t at_ns,
            std::vector<sim::JointMotion>& motions) const;
  void write(std::span<const sim::JointMotion> motions, erp::JointTarget& message) const;
  /// Writes a message with variances by coordinate of the model. Fixed joints and joints
  /// that are not `known` are omitted. If `known` is empty, all joints are known.
  void write(std::span<const sim::JointReading> readings, const Eigen::VectorXd& variance_rad2,
             const sim::SkeletonModel& model, erp::JointState& message,
             const std::vector<bool>& known = {}) const;

 private:
  template <class Message, class Take>
  bool for_each_movable(const Message& message, Take read_one) const;
  std::vector<erp::Joint> joints_;
};

/// Largest rotation of a joint between two positions, in rad.
double largest_rotation_rad(std::span<const sim::JointReading> a,
                            std::span<const sim::JointMotion> b);

/// Transition from the current joint motion to the desired motion, at about `rad_per_s` and in at
/// least 0.2 s.
sim::CatchUp catch_up(std::span<const sim::JointReading> now,
                      std::span<const sim::JointMotion> desired, double rad_per_s);

}  // namespace joints
