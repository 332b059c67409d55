// The stage of the joints: what the bones' motion, the tendons and the joints' friction leave over.
#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/diagnosis/stages.hpp"

namespace sim::diagnosis {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double resting_rad_per_s = 0.02;  // chosen: a joint slower than this may stick
constexpr double near_stop_rad = 0.02;      // chosen: its stop may push
constexpr double stop_Nm_per_rad = 100;     // chosen: how hard a stop is to pass

std::pair<double, double> range(const Signal& signal, const Bump& bump, std::size_t row) {
  const auto first = signal.begin() + static_cast<std::ptrdiff_t>(row - bump.reach());
  const auto [low, high] =
      std::minmax_element(first, first + static_cast<std::ptrdiff_t>(2 * bump.reach() + 1));
  return {*low, *high};
}

}  // namespace

JointTrace Stages::joint_trace(const Episode& episode, std::span<const std::size_t> rows) const {
  const auto& joints = bones_.joint_list();
  JointTrace trace;
  trace.signals.resize(joints.size());  // an effect may have added some
  const Bump bump(windows_.half_width_s, episode.period_s);
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const auto recorded = std::ranges::find(recorded_joints_, joints[j].name);
    if (recorded != recorded_joints_.end())
      trace.signals[j] =
          episode.joints[static_cast<std::size_t>(recorded - recorded_joints_.begin())];
    Signal& angle = trace.signals[j].angle_rad;
    effects::Acting acting(equipped_.acting, joints[j].name, effects::Seat::joint);
    if (!acting.empty())
      for (std::size_t k = 0; k < angle.size(); ++k)
        angle[k] = acting.undo(effects::Sense::joint, angle[k],
                               {episode.period_s * double(k), episode.period_s, 1});
    trace.speed_rad_per_s.push_back(bump.rates(angle));
  }
  if (bones_.measured(trace.signals))
    for (const std::size_t row : rows)
      trace.motions.push_back(bones_.motion(trace.signals, bump, row));
  return trace;
}

/// Adds what a joint's friction and springs take along its coordinates. False: a ball joint rests.
bool Stages::pass_joint(std::size_t j, const JointReading& reading,
                        Eigen::Ref<Eigen::VectorXd> torque) const {
  const erp::Joint& joint = bones_.joint_list()[j];
  const Eigen::Map<const Eigen::VectorXd> velocity(reading.velocity_rad_per_s.data(),
                                                   torque.size());
  const double speed = velocity.norm();
  effects::Acting acting(equipped_.acting, joint.name, effects::Seat::joint);
  if (torque.size() == 1) torque[0] -= acting.joint_torque(reading.position[0]).value;
  torque += joint.viscous_Nm_s_per_rad * velocity;
  if (speed < resting_rad_per_s) return torque.size() == 1;
  torque += (joint.coulomb_Nm + acting.joint_friction_Nm(speed)) * velocity / speed;
  return true;
}

Eigen::MatrixXd Stages::bones(const Episode&, const JointTrace& joints,
                              std::span<const std::size_t> rows) {
  const auto columns = static_cast<Eigen::Index>(joints.motions.empty() ? 0 : rows.size());
  Eigen::MatrixXd torques = Eigen::MatrixXd::Constant(bones_.coordinates(), columns, nan);
  for (Eigen::Index k = 0; k < columns; ++k) {
    const Motion& motion = joints.motions[static_cast<std::size_t>(k)];
    if (!motion.taken) continue;
    Eigen::VectorXd torque = bones_.inverse(motion);
    for (std::size_t j = 0; j < motion.joints.size(); ++j) {
      const int first = bones_.first_of(static_cast<int>(j));
      if (first < 0) continue;
      auto part = torque.segment(first, coordinates_of(motion.joints[j].type));
      if (!pass_joint(j, motion.joints[j], part)) part.setConstant(nan);
    }
    torques.col(k) = torque;
  }
  return torques;
}

Stages::Gait Stages::gait(const JointTrace& joints, std::size_t j, const Bump& bump,
                          std::size_t row) const {
  const auto [slowest, fastest] = range(joints.speed_rad_per_s[j], bump, row);
  if (slowest > resting_rad_per_s || fastest < -resting_rad_per_s) return Gait::glides;
  const double mean = bump.rate(joints.signals[j].angle_rad, row);
  const bool still = std::max(-slowest, fastest) < resting_rad_per_s;
  return still && std::abs(mean) < resting_rad_per_s ? Gait::rests : Gait::mixed;
}

/// What is left of a revolute joint's balance once a resting joint's friction and the push of a
/// stop have taken their share.
double Stages::leave(const JointTrace& joints, std::size_t j, const Bump& bump, std::size_t row,
                     double torque_Nm) const {
  const erp::Joint& joint = bones_.joint_list()[j];
  if (joints.signals[j].angle_rad.empty()) return torque_Nm;
  const Gait gait = this->gait(joints, j, bump, row);
  if (gait == Gait::mixed) return nan;
  if (gait == Gait::rests) {
    effects::Acting acting(equipped_.acting, joint.name, effects::Seat::joint);
    const double band = joint.coulomb_Nm + acting.joint_friction_Nm(0);
    torque_Nm = std::copysign(std::max(0.0, std::abs(torque_Nm) - band), torque_Nm);
  }
  const auto [lowest, highest] = range(joints.signals[j].angle_rad, bump, row);
  if (highest > joint.max_rad - near_stop_rad)
    torque_Nm = std::max(0.0, torque_Nm) +
                stop_Nm_per_rad * std::max(0.0, highest - joint.max_rad - near_stop_rad);
  if (lowest < joint.min_rad + near_stop_rad)
    torque_Nm = std::min(0.0, torque_Nm) -
                stop_Nm_per_rad * std::max(0.0, joint.min_rad - near_stop_rad - lowest);
  return torque_Nm;
}

void Stages::add_joints(const Episode& episode, Explanation& e) const {
  if (e.joints->motions.empty()) return;
  for (const auto& chain : e.chains)
    if (chain->tension_N.empty()) return;
  const Bump bump(windows_.half_width_s, episode.period_s);
  Eigen::MatrixXd torques = *e.bones;
  for (std::size_t a = 0; a < e.chains.size(); ++a) {
    const ChainTrace& c = *e.chains[a];
    for (Eigen::Index k = 0; k < torques.cols(); ++k) {
      const std::size_t row = e.rows[static_cast<std::size_t>(k)];
      const double slope = c.path_slope.empty() ? 1 : c.path_slope[row];
      torques.col(k) += bump.mean(c.tension_N, row) * slope * e.gradients[a]->col(k);
    }
  }
  const auto& joints = bones_.joint_list();
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const int first = bones_.first_of(static_cast<int>(j)), count = coordinates_of(joints[j].type);
    if (first < 0 || !std::ranges::count(recorded_joints_, joints[j].name)) continue;
    for (int d = first; d < first + count; ++d) {
      Residual residual{effects::Stage::joint, joints[j].name, "Nm", {}};
      for (Eigen::Index k = 0; k < torques.cols(); ++k)
        residual.value.push_back(
            count == 1 ? leave(*e.joints, j, bump, e.rows[std::size_t(k)], torques(d, k))
                       : torques(d, k));
      e.residuals.push_back(std::move(residual));
    }
  }
}

}  // namespace sim::diagnosis
