#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "interfaces/robot/robot.hpp"

/// Determines which actuators must take their safe action because an actuator of the same limb is
/// lost. Otherwise a motor would pull without resistance from its antagonist, which is off.
///
///   lost      its ECU has reported before, but not for `lost_ns`
///   degraded  an actuator of the same limb is lost
namespace plant {

class LimbMonitor {
 public:
  LimbMonitor(const erp::Robot& robot, std::int64_t lost_ns) : lost_ns_(lost_ns) {
    std::map<std::string, std::size_t> limb_index;
    for (const erp::Actuator& actuator : robot.actuators)
      members_.push_back({limb_index.emplace(actuator.limb, limb_index.size()).first->second});
    degraded_.resize(limb_index.size());
  }

  void on_sample(std::size_t actuator, std::int64_t now_ns) {
    members_[actuator].has_reported = true;
    members_[actuator].last_ns = now_ns;
  }
  /// Evaluates the timeouts. Call before `lost` and `degraded`.
  void update(std::int64_t now_ns) {
    degraded_.assign(degraded_.size(), false);
    for (Member& member : members_) {
      member.lost = member.has_reported && now_ns - member.last_ns >= lost_ns_;
      if (member.lost) degraded_[member.limb] = true;
    }
  }
  bool lost(std::size_t actuator) const { return members_[actuator].lost; }
  bool degraded(std::size_t actuator) const { return degraded_[members_[actuator].limb]; }

 private:
  struct Member {
    std::size_t limb;
    bool has_reported = false, lost = false;
    std::int64_t last_ns = 0;
  };
  std::int64_t lost_ns_;
  std::vector<Member> members_;
  std::vector<bool> degraded_;
};

}  // namespace plant
