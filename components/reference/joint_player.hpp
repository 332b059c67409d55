#pragma once
#include <filesystem>
#include <optional>
#include <string>

#include "components/joints/joints.hpp"
#include "components/node/run.hpp"
#include "sim/control/pose_plan.hpp"
#include "sim/model/skeleton/catch_up.hpp"

/// Leads the joints through the poses of a file with the least jerk, with a halt in each or without.
///
/// It begins where the robot is, and goes from there to the first pose no faster than
/// `start_rad_per_s`. Should the robot be farther than `lost_rad` from where it was led, because it
/// was moved, or is another one since a restart, or should frames have been missing, as when the
/// plant was away, it is led on from where it is and as it moves: catch_up.hpp. The way's time stands
/// still while frames are missing, and until the first pose is reached.
namespace reference {

class JointPlayer {
 public:
  struct Params {
    xml::Place place;
    std::string file;               ///< poses.csv, relative to the config that names it
    sim::Via via = sim::Via::rest;  ///< whether it halts in each pose
    bool loop = false;  ///< from the last pose to the first, as far as they are apart in time
    std::string source = "sim";    ///< whose joint_state says where the robot is
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

  /// Throws std::invalid_argument as poses_of, and where a way between two poses leaves a joint's
  /// range; recording::RecordingError.
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
  sim::JointPath path_;
  sim::CatchUp catch_up_;
  std::vector<sim::JointReading> now_;
  std::vector<sim::JointMotion> led_;
  bool begun_ = false, there_ = false;     ///< there: on the way, once
  double path_s_ = 0, catching_up_s_ = 0;  ///< since either began
};

}  // namespace reference

template <>
struct xml::Names<sim::Via> {
  static constexpr auto list = std::to_array<std::pair<const char*, sim::Via>>(
      {{"rest", sim::Via::rest}, {"through", sim::Via::through}});
};
