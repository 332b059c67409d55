#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "interfaces/robot/robot.hpp"

/// Determines which actuators must take their safe action because an actuator of the same limb is
/// lost: no antagonist would hold back a motor that pulls against one that is off.
///
///   lost      its ECU has reported before, but not for `lost_ns`
///   degraded  an actuator of the same limb is lost
namespace plant {

class LimbMonitor {
 public:
  LimbMonitor(const erp::Robot& robot, std::int64_t lost_ns) : lost_ns_(lost_ns) {
    std::map<std::string, std::size_t> limb_of;
    for (const erp::Actuator& actuator : robot.actuators)
      members_.push_back({limb_of.emplace(actuator.limb, limb_of.size()).first->second});
    degraded_.resize(limb_of.size());
  }

  void on_sample(std::size_t actuator, std::int64_t now_ns) {
    members_[actuator].known = true;
    members_[actuator].last_ns = now_ns;
  }
  /// Evaluates the timeouts. Call before `lost` and `degraded`.
  void update(std::int64_t now_ns) {
    degraded_.assign(degraded_.size(), false);
    for (Member& m : members_) {
      m.lost = m.known && now_ns - m.last_ns >= lost_ns_;
      if (m.lost) degraded_[m.limb] = true;
    }
  }
  bool lost(std::size_t actuator) const { return members_[actuator].lost; }
  bool degraded(std::size_t actuator) const { return degraded_[members_[actuator].limb]; }

 private:
  struct Member {
    std::size_t limb;
    bool known = false, lost = false;
    std::int64_t last_ns = 0;
  };
  std::int64_t lost_ns_;
  std::vector<Member> members_;
  std::vector<bool> degraded_;
};

}  // namespace plant
