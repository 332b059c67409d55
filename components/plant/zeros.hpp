#pragma once
#include <string>
#include <vector>

#include "components/plant/notice.hpp"
#include "components/plant/zero.hpp"

/// The zeros of all encoders of a robot, and the sources from which unknown ones are set without a
/// command: potentiometers, and the starting pose if robot.xml states that the robot is switched on in
/// it and its joint sensors agree. Reads no clock.
namespace plant {

class Zeros {
 public:
  /// `rad_per_count`: of the shaft, one per actuator.
  Zeros(const erp::Robot& robot, const std::vector<double>& rad_per_count);

  bool is_known(std::size_t actuator) const { return zeros_[actuator].is_known(); }
  void observe(std::size_t actuator, const erp::EcuChannelSample& counts, std::int64_t now_ns);
  void observe_potentiometer(std::size_t actuator, double reading_rad, std::int64_t now_ns) {
    zeros_[actuator].observe_potentiometer(reading_rad, now_ns);
  }
  /// `sensor`: index in robot.xml's joint sensors.
  void observe_joint(std::size_t sensor, double angle_rad) {
    joints_[sensor].reading_rad = angle_rad;
  }
  /// To be called after all readings of a frame.
  void update(std::int64_t now_ns);
  /// See Zero::set.
  void set(std::size_t actuator, double shaft_rad, const std::string& source, std::int64_t now_ns) {
    zeros_[actuator].set(shaft_rad, source, now_ns);
  }
  void append_next(erp::EcuParameter& message, std::int64_t now_ns);
  /// The changes since the last call.
  std::vector<Notice> take_notices() { return std::exchange(notices_, {}); }

 private:
  struct Candidate {
    bool is_open = false;  ///< the ECU was in boot, with unknown zero, when it was first seen
    bool is_observed = false;
    std::int64_t since_ns = 0;
  };
  struct JointReading {
    std::string joint;
    double start_rad;
    std::optional<double> reading_rad;
  };
  bool is_waiting_for_joints(std::int64_t now_ns) const;
  std::string deviation() const;
  void report(std::size_t actuator, Zero::Change change);

  std::vector<std::string> names_;
  std::vector<Zero> zeros_;
  std::vector<Candidate> candidates_;
  std::vector<JointReading> joints_;
  bool starts_in_pose_, has_moved_ = false, reported_deviation_ = false;
  std::vector<Notice> notices_;
};

}  // namespace plant
