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
/// restarted), or after missing frames (the plant did not run), the motion resumes from the robot's
/// current position and velocity: catch_up.hpp. The path time does not advance during missing
/// frames and before the first pose is reached.
namespace reference {

class JointPlayer {
 public:
  struct Params {
    xml::Place place;
    std::string file;
    sim::Via via = sim::Via::rest;
    bool loop = false;
    std::string source = "sim";
    double start_rad_per_s = 0.5;
    double lost_rad = 0.6;
    void visit(auto& v) {
      v.required("file", file, "Poses (CSV: time_s and the joints), relative to the config.");
      v("via", via,
        "Whether the motion stops in each pose (rest) or only in repeated ones (through).");
      v("loop", loop,
        "Whether the motion is repeated; from the last pose to the first in the time between the "
        "first two.");
      v("source", source,
        "Component whose joint_state is used: sim, pose_estimator or motion_capture.");
      v("start_rad_per_s", start_rad_per_s,
        {xml::positive, "Largest speed of the approach to the first pose; chosen."});
      v("lost_rad", lost_rad,
        {xml::positive,
         "Distance of the robot from the reference from which the motion resumes at the robot; "
         "chosen."});
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
  std::vector<sim::JointReading> measured_;
  std::vector<sim::JointMotion> reference_;
  bool has_begun_ = false, on_path_ = false;  ///< on_path_: the first pose has been reached
  double path_s_ = 0, catching_up_s_ = 0;     ///< time on the path; time since the catch-up began
};

}  // namespace reference

template <>
struct xml::Names<sim::Via> {
  static constexpr auto list = std::to_array<std::pair<const char*, sim::Via>>(
      {{"rest", sim::Via::rest}, {"through", sim::Via::through}});
};
