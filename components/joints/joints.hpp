#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "interfaces/robot/robot.hpp"
#include "interfaces/topics.hpp"
#include "sim/skeleton/joint_path.hpp"

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
  void write(std::span<const sim::JointMotion> motions, erp::JointTarget& message) const;

 private:
  template <class Message, class Take>
  bool each(const Message& message, Take take) const;
  std::vector<erp::Joint> joints_;
};

/// How far apart two places of the joints are: the largest turn of any, rad.
double apart_rad(std::span<const sim::JointReading> a, std::span<const sim::JointMotion> b);

}  // namespace joints
