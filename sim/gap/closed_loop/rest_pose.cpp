#include "sim/gap/closed_loop/rest_pose.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim/world/world.hpp"

namespace sim::closed_loop {
namespace {

constexpr double dt_s = 0.001;
constexpr double rest_s = 0.1;            ///< duration of rest at the end of a motion; chosen
constexpr double full_voltage_rad = 0.1;  ///< error at which the supply voltage is reached; chosen
constexpr double integral_s = 0.2;        ///< time constant of the integral part; chosen

class Winder {
 public:
  explicit Winder(const erp::Robot& robot) : robot_(robot), world_(robot) {
    start_rad_ = integral_V_ = voltage_V_ = std::vector<double>(robot.actuators.size());
  }

  RestPose move_to(const std::vector<double>& shaft_rad, const RestPoseOptions& options) {
    for (std::size_t a = 0; a < start_rad_.size(); ++a)
      start_rad_[a] = world_.actuators()[a].shaft_rad;
    double still_since_s = 0;
    for (int k = 0; dt_s * k < options.longest_s; ++k) {
      const double at_s = dt_s * k;
      step(shaft_rad, std::min(1.0, at_s / options.ramp_s));
      if (at_s < options.ramp_s || !is_at_rest(shaft_rad, options)) still_since_s = at_s;
      if (at_s - still_since_s > rest_s) return {pose(), at_s, true};
    }
    return {pose(), options.longest_s, false};
  }

 private:
  void step(const std::vector<double>& shaft_rad, double progress) {
    for (std::size_t a = 0; a < voltage_V_.size(); ++a) {
      const double supply_V = robot_.motor_of(robot_.actuators[a]).supply_V;
      const double desired_rad = start_rad_[a] + progress * (shaft_rad[a] - start_rad_[a]);
      const double proportional_V =
          supply_V * (desired_rad - world_.actuators()[a].shaft_rad) / full_voltage_rad;
      integral_V_[a] =
          std::clamp(integral_V_[a] + proportional_V * dt_s / integral_s, -supply_V, supply_V);
      voltage_V_[a] = std::clamp(proportional_V + integral_V_[a], -supply_V, supply_V);
    }
    world_.step(voltage_V_, dt_s);
    if (!world_.is_finite()) throw std::runtime_error("the robot's motion is not finite");
  }

  bool is_at_rest(const std::vector<double>& shaft_rad, const RestPoseOptions& options) const {
    for (std::size_t a = 0; a < shaft_rad.size(); ++a)
      if (std::abs(world_.actuators()[a].shaft_rad - shaft_rad[a]) > options.tolerance_rad)
        return false;
    return std::ranges::all_of(world_.joints(), [&](const JointReading& joint) {
      const auto& v = joint.velocity_rad_per_s;
      return std::hypot(v[0], v[1], v[2]) < options.still_rad_per_s;
    });
  }

  Pose pose() const {
    Pose pose;
    for (const JointReading& joint : world_.joints()) pose.push_back(joint.position);
    return pose;
  }

  const erp::Robot& robot_;
  World world_;
  std::vector<double> start_rad_, integral_V_, voltage_V_;
};

}  // namespace

std::vector<RestPose> rest_poses(const erp::Robot& robot,
                                 std::span<const std::vector<double>> shafts_rad,
                                 const RestPoseOptions& options) {
  Winder winder(robot);
  std::vector<RestPose> all;
  for (const auto& shaft_rad : shafts_rad) all.push_back(winder.move_to(shaft_rad, options));
  return all;
}

}  // namespace sim::closed_loop
