#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "interfaces/robot/robot.hpp"

/// Which actuators must drop to their safe action because one of their limb is lost: what pulls
/// against a motor that is off would not be held back.
///
///   lost    its ECU was heard once, and not for `lost_ns`
///   broken  one of the same limb is lost
namespace plant {

class Limbs {
 public:
  Limbs(const erp::Robot& robot, std::int64_t lost_ns) : lost_ns_(lost_ns) {
    std::map<std::string, std::size_t> limb_of;
    for (const erp::Actuator& actuator : robot.actuators)
      members_.push_back({limb_of.emplace(actuator.limb, limb_of.size()).first->second});
    broken_.resize(limb_of.size());
  }

  void heard(std::size_t actuator, std::int64_t now_ns) {
    members_[actuator].known = true;
    members_[actuator].last_ns = now_ns;
  }
  /// Looks at the time. Call before asking.
  void look(std::int64_t now_ns) {
    broken_.assign(broken_.size(), false);
    for (Member& m : members_) {
      m.lost = m.known && now_ns - m.last_ns >= lost_ns_;
      if (m.lost) broken_[m.limb] = true;
    }
  }
  bool lost(std::size_t actuator) const { return members_[actuator].lost; }
  bool broken(std::size_t actuator) const { return broken_[members_[actuator].limb]; }

 private:
  struct Member {
    std::size_t limb;
    bool known = false, lost = false;
    std::int64_t last_ns = 0;
  };
  std::int64_t lost_ns_;
  std::vector<Member> members_;
  std::vector<bool> broken_;
};

}  // namespace plant
