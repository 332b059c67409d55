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

/// The joints of a robot, in its order, as they cross the bus by name.
namespace joints {

class Names {
 public:
  explicit Names(const erp::Robot& robot);

  std::size_t size() const { return joints_.size(); }
  std::span<const erp::Joint> list() const { return joints_; }

  /// False, and nothing of use: a joint that turns is not in the message, or is no number.
  bool read(const erp::JointState& message, std::vector<sim::JointReading>& readings) const;
  bool read(const erp::JointTarget& message, std::vector<sim::JointMotion>& motions) const;
  /// The same at `at_ns`: what was said of a moment before or after is brought there as it moves,
  /// q ⊕ v dt. Beyond 50 ms it is left as it was: clocks of computers may differ.
  bool read(const erp::JointState& message, std::int64_t at_ns,
            std::vector<sim::JointReading>& readings) const;
  bool read(const erp::JointTarget& message, std::int64_t at_ns,
            std::vector<sim::JointMotion>& motions) const;
  void write(std::span<const sim::JointMotion> motions, erp::JointTarget& message) const;
  /// With variances by coordinate of the model. Joints that do not move are left out, and those that
  /// are not `known`; empty: all are.
  void write(std::span<const sim::JointReading> readings, const Eigen::VectorXd& variance_rad2,
             const sim::SkeletonModel& model, erp::JointState& message,
             const std::vector<bool>& known = {}) const;

 private:
  template <class Message, class Take>
  bool each(const Message& message, Take take) const;
  std::vector<erp::Joint> joints_;
};

/// How far apart two places of the joints are: the largest turn of any, rad.
double apart_rad(std::span<const sim::JointReading> a, std::span<const sim::JointMotion> b);

/// From where the joints are and as they move onto what is wanted of them, about as fast as that
/// and in 0.2 s at least.
sim::CatchUp onto(std::span<const sim::JointReading> now, std::span<const sim::JointMotion> wanted,
                  double rad_per_s);

}  // namespace joints
