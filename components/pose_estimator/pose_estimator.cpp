#include "components/pose_estimator/pose_estimator.hpp"

#include <algorithm>
#include <cmath>

#include "sim/model/actuator/sensors.hpp"

namespace pose {
namespace {

const double quantization_counts = 1 / std::sqrt(12.0);  // σ of quantization

}  // namespace

PoseEstimator::PoseEstimator(const Params& params, const erp::Robot& robot)
    : params_(params), robot_(robot), names_(robot), filter_(robot, params) {
  const auto& lengths = filter_.model().length_m();
  for (const erp::Actuator& a : robot_.actuators) {
    const erp::SensorType& sensors = robot_.sensors_of(a);
    const sim::SensorScale scale(robot_.motor_of(a), sensors);
    const auto i = static_cast<Eigen::Index>(tendons_.size());
    tendons_.push_back(
        {a.name, sim::TendonLaw::at_rest(a.tendon, a.spindle, lengths[i]),
         std::hypot(sensors.tension_noise_N, quantization_counts * scale.tension_N_per_count),
         quantization_counts * scale.shaft_rad_per_count});
  }
  const auto& bodies = filter_.model().tree().names;
  for (const erp::Imu& imu : robot_.imus)
    imu_bodies_.push_back(
        static_cast<int>(sim::body_named(bodies, imu.body, "inertial unit \"" + imu.name + "\"")));
  tension_N_.setZero(lengths.size());
  length_rate_m_per_s_.setZero(lengths.size());
}

erp::JointState PoseEstimator::step(const erp::SensorFrame& frame, double dt_s,
                                    const node::Latest<erp::JointState>& capture,
                                    const node::Latest<erp::ImuFrame>& imus) {
  if (dt_s > 0) filter_.predict(dt_s, tension_N_);
  read_sensors(frame, dt_s);
  update_from_tendons();
  if (params_.joint_sensors) update_from_joints(frame);
  update_from_capture(capture);
  if (params_.imus) update_from_imus(imus);
  filter_.apply_correction();
  return estimate();
}

void PoseEstimator::read_sensors(const erp::SensorFrame& frame, double dt_s) {
  constexpr auto needed = erp::valid::shaft | erp::valid::tension;
  for (Tendon& tendon : tendons_) tendon.is_measured = false;
  for (const erp::ActuatorSample& sample : erp::samples(frame.actuators)) {
    const auto tendon_of_sample =
        std::ranges::find_if(tendons_, [&](const auto& t) { return t.name == sample.name; });
    if (tendon_of_sample == tendons_.end() || (sample.valid & needed) != needed) continue;
    tendon_of_sample->speed_rad_per_s =
        dt_s > 0 ? (sample.shaft_rad - tendon_of_sample->shaft_rad) / dt_s : 0;
    tendon_of_sample->shaft_rad = sample.shaft_rad;
    tendon_of_sample->tension_N = std::max(0.0, sample.tension_N);
    tendon_of_sample->is_measured = true;
  }
}

void PoseEstimator::update_from_tendons() {
  length_rate_m_per_s_.noalias() = filter_.model().jacobian() * filter_.speed_rad_per_s();
  for (std::size_t a = 0; a < tendons_.size(); ++a) {
    const Tendon& t = tendons_[a];
    const auto i = static_cast<Eigen::Index>(a);
    if (!t.is_measured) continue;  // tension_N_ keeps the last measured tension
    tension_N_[i] = t.tension_N;
    if (t.tension_N < params_.slack_N) continue;
    const double rate = length_rate_m_per_s_[i] + t.law.radius_m * t.speed_rad_per_s;
    const double spring_N = std::max(0.0, t.tension_N - t.law.damping_N_s_per_m * rate);
    const double stretch_m = t.law.spring.stretch_m(spring_N);
    const double length_m = t.law.length_m(spring_N, t.shaft_rad);
    const double sigma_m = std::hypot(t.tension_sigma_N / t.law.spring.slope_N_per_m(stretch_m),
                                      t.shaft_sigma_rad * t.law.radius_m, params_.model_m);
    filter_.update_length(static_cast<int>(a), length_m, sigma_m);
  }
}

/// Sensors of revolute joints.
void PoseEstimator::update_from_joints(const erp::SensorFrame& frame) {
  for (const erp::JointSample& sample : erp::samples(frame.joints))
    for (std::size_t j = 0; j < names_.size(); ++j) {
      const bool matches =
          names_.list()[j].name == sample.name && names_.list()[j].type == erp::JointType::revolute;
      if (!matches || !(sample.valid & erp::valid::joint_angle)) continue;
      for (const erp::JointSensor& sensor : robot_.joint_sensors)
        if (sensor.joint == sample.name)
          filter_.update_joint(
              static_cast<int>(j), {sample.angle_rad},
              std::hypot(sensor.noise_rad, quantization_counts * 2 * std::numbers::pi /
                                               std::exp2(sensor.bits_per_rev)));
    }
}

/// Uses each capture message once.
void PoseEstimator::update_from_capture(const node::Latest<erp::JointState>& capture) {
  if (!capture || capture.arrived_ns == last_capture_ns_) return;
  last_capture_ns_ = capture.arrived_ns;
  if (!names_.read(capture.message, captured_)) return;
  for (std::size_t j = 0; j < captured_.size(); ++j)
    filter_.update_joint(static_cast<int>(j), captured_[j].position, params_.capture_rad);
}

/// Uses each IMU frame once.
void PoseEstimator::update_from_imus(const node::Latest<erp::ImuFrame>& imus) {
  if (!imus || imus.arrived_ns == last_imu_ns_) return;
  last_imu_ns_ = imus.arrived_ns;
  for (const erp::ImuSample& sample : erp::samples(imus->imus))
    for (std::size_t k = 0; k < robot_.imus.size(); ++k) {
      const erp::Imu& unit = robot_.imus[k];
      if (unit.name != sample.name) continue;
      const double counts = std::exp2(unit.bits);
      filter_.update_angular_velocity(
          imu_bodies_[k], Eigen::Map<const sim::Vec3>(sample.turning_rad_per_s),
          std::hypot(unit.turning_noise_rad_per_s,
                     quantization_counts * 2 * unit.turning_range_rad_per_s / counts));
      filter_.update_gravity(
          imu_bodies_[k], Eigen::Map<const sim::Vec3>(sample.acceleration_m_per_s2),
          std::hypot(unit.acceleration_noise_m_per_s2, params_.acceleration_sigma_m_per_s2));
    }
}

erp::JointState PoseEstimator::estimate() {
  erp::JointState state;
  erp::assign(state.source, "pose_estimator");
  variance_rad2_ = filter_.covariance().diagonal().head(filter_.model().coordinates());
  names_.write(filter_.joints(), variance_rad2_, filter_.model().skeleton(), state);
  return state;
}

}  // namespace pose
