#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "components/joints/joints.hpp"
#include "components/node/run.hpp"
#include "sim/actuator/pose_plan.hpp"

/// Leads the joints through the poses of a file, with the least jerk from one to the next.
///
/// It begins where the robot is, and goes from there to the first pose no faster than
/// `start_rad_per_s`. Should the robot be farther than `lost_rad` from where it was led, because it
/// was moved, or is another one since a restart, the way is picked up again from where it is now.
namespace reference {

class JointPlayer {
 public:
  struct Params {
    xml::Place place;
    std::string file;   ///< poses.csv, relative to the config that names it
    bool loop = false;  ///< from the last pose to the first, as far as they are apart in time
    std::string source = "sim";    ///< whose joint_state says where the robot is
    double start_rad_per_s = 0.5;  ///< chosen
    double lost_rad = 0.6;         ///< chosen
    void visit(auto& v) {
      v.required("file", file);
      v("loop", loop);
      v("source", source);
      v("start_rad_per_s", start_rad_per_s, xml::positive);
      v("lost_rad", lost_rad, xml::positive);
    }
  };

  /// Throws std::invalid_argument as poses_of, and recording::RecordingError.
  JointPlayer(const Params& params, const erp::Robot& robot);

  bool wants(const erp::JointState& state) const { return params_.source == state.source; }
  /// Nothing before the robot's joints are known.
  std::optional<erp::JointTarget> step(const erp::SensorFrame& frame, double dt_s,
                                       const node::Latest<erp::JointState>& state);

 private:
  void lead();
  void pick_up();

  Params params_;
  joints::Names names_;
  sim::JointPath path_, start_;
  std::vector<sim::JointReading> now_;
  std::vector<sim::JointMotion> led_;
  bool starting_ = false, begun_ = false;
  double path_s_ = 0, start_s_ = 0;  ///< on each of the ways
};

}  // namespace reference
