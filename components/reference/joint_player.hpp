#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "components/joints/joints.hpp"
#include "components/node/run.hpp"
#include "sim/control/pose_plan.hpp"
#include "sim/model/skeleton/catch_up.hpp"

/// Guides the joints through the poses of a file with minimum jerk, with or without a stop in each
/// pose.
///
/// It begins at the robot's current position and moves from there to the first pose at no more than
/// `start_rad_per_s`. If the robot is farther than `lost_rad` from the reference (it was moved or
/// restarted), or after missing frames (the plant was absent), the motion resumes from the robot's
/// current position and velocity: catch_up.hpp. The path time does not advance during missing
/// frames and before the first pose is reached.
namespace reference {

class JointPlayer {
 public:
  struct Params {
    xml::Place place;
    std::string file;               ///< poses.csv, relative to the config that names it
    sim::Via via = sim::Via::rest;  ///< whether the motion stops in each pose
    /// Repeat; from the last pose to the first in the time between the first two.
    bool loop = false;
    std::string source = "sim";    ///< source of the joint_state that is used
    double start_rad_per_s = 0.5;  ///< chosen
    double lost_rad = 0.6;         ///< chosen
    void visit(auto& v) {
      v.required("file", file);
      v("via", via);
      v("loop", loop);
      v("source", source);
      v("start_rad_per_s", start_rad_per_s, xml::positive);
      v("lost_rad", lost_rad, xml::positive);
    }
  };

  /// Throws std::invalid_argument as poses_of, and if the path leaves a joint's range;
  /// recording::RecordingError.
  JointPlayer(const Params& params, const erp::Robot& robot);

  bool accepts(const erp::JointState& state) const { return params_.source == state.source; }
  /// nullopt before the robot's joints are known.
  std::optional<erp::JointTarget> step(const erp::SensorFrame& frame, double dt_s,
                                       const node::Latest<erp::JointState>& state);

 private:
  void update_reference();
  void begin_catch_up();

  Params params_;
  joints::Names names_;
  sim::JointPath path_;
  sim::CatchUp catch_up_;
  std::vector<sim::JointReading> now_;
  std::vector<sim::JointMotion> reference_;
  bool begun_ = false, on_path_ = false;   ///< on_path_: the first pose has been reached
  double path_s_ = 0, catching_up_s_ = 0;  ///< time on the path; time since the catch-up began
};

}  // namespace reference

template <>
struct xml::Names<sim::Via> {
  static constexpr auto list = std::to_array<std::pair<const char*, sim::Via>>(
      {{"rest", sim::Via::rest}, {"through", sim::Via::through}});
};
