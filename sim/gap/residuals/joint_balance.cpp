// The stage of the joints: what the bones' motion, the tendons and the joints' friction leave over.
#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/gap/residuals/loose_joint.hpp"
#include "sim/gap/residuals/stages.hpp"

namespace sim::residuals {
namespace {

double rms(const Eigen::RowVectorXd& values) {
  double square = 0, count = 0;
  for (const double x : values)
    if (!std::isnan(x)) square += x * x, ++count;
  return count > 0 ? std::sqrt(square / count) : 0;
}

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double resting_rad_per_s = 0.02;  // chosen: a joint slower than this may stick
constexpr double near_stop_rad = 0.02;      // chosen: its stop may push
constexpr double stop_gives_rad = 0.06;     // chosen: how far a stop may give way
constexpr double stop_Nm_per_rad = 20;      // chosen: how hard it is to pass beyond that

std::pair<double, double> range(const Signal& signal, const Bump& bump, std::size_t row) {
  const auto first = signal.begin() + static_cast<std::ptrdiff_t>(row - bump.reach());
  const auto [low, high] =
      std::minmax_element(first, first + static_cast<std::ptrdiff_t>(2 * bump.reach() + 1));
  return {*low, *high};
}

/// Whether a ball joint's stop may push: it pushes along the axis of the rotation.
bool near_stop(const JointReading& reading, const erp::Joint& joint, double speed_rad_per_s,
               double half_width_s) {
  const double angle_rad = 2 * std::acos(std::min(1.0, std::abs(reading.position[0])));
  return angle_rad + speed_rad_per_s * half_width_s > joint.max_rad - near_stop_rad;
}

}  // namespace

/// Bones that bend have joints that nobody measured. Each moves as its spring and damper have it,
/// its bone carried by the measured joints:
///
///   I δ̈ = −(τ(q, q̇, q̈, δ, δ̇, 0) + k δ + D δ̇)          τ: inverse dynamics, by the trapezoidal rule
///
/// Carried by means over the windows, it moves as its own means do: they are not taken again.
std::vector<Stages::Bend> Stages::bend(const Episode& episode, JointTrace& trace) {
  std::vector<Bend> bends;
  const Bump bump(windows_.half_width_s, episode.period_s);
  const std::size_t reach = 2 * bump.reach() + 1;
  for (std::size_t j = 0; j < trace.signals.size(); ++j) {
    const erp::Joint& joint = bones_.joint_list()[j];
    const int coordinate = bones_.first_of(static_cast<int>(j));
    if (coordinate < 0 || std::ranges::count(recorded_joints_, joint.name)) continue;
    effects::Acting acting(equipped_.acting, joint.name, effects::Seat::joint);
    const double stiffness = -acting.joint_torque(0).slope;
    Signal& bent = trace.signals[j].angle_rad;
    bent.assign(episode.rows, 0.0);
    trace.by_bones = true;
    if (!(stiffness > 0) || !bones_.measured(trace.signals)) continue;
    auto& states = bends.emplace_back(j, std::vector<std::array<double, 3>>(episode.rows)).states;
    double angle = 0, speed = 0;
    bool started = false;
    for (std::size_t k = reach; k + reach < episode.rows; ++k) {
      Motion motion = bones_.motion(trace.signals, bump, k);
      if (!motion.taken) continue;
      motion.joints[j].position[0] = angle, motion.joints[j].velocity_rad_per_s[0] = speed;
      motion.acceleration[coordinate] = 0;
      const double needed = bones_.inverse(motion)[coordinate];
      if (!started) {
        angle = -needed / stiffness, started = true;
      } else {
        motion.acceleration[coordinate] = 1;
        const double inertia = bones_.inverse(motion)[coordinate] - needed;
        const double half_s = episode.period_s / 2, damping = joint.viscous_Nm_s_per_rad;
        const double pushed = needed + stiffness * angle + damping * speed;
        states[k] = {angle, speed, -pushed / inertia};
        const double faster = -2 * half_s * (pushed + half_s * stiffness * speed) /
                              (inertia + half_s * damping + half_s * half_s * stiffness);
        angle += half_s * (2 * speed + faster), speed += faster;
      }
      bent[k] = std::clamp(angle, -3.0, 3.0);
    }
  }
  return bends;
}

JointTrace Stages::joint_trace(const Episode& episode, std::span<const std::size_t> rows,
                               const JointTrace* guess) {
  const auto& joints = bones_.joint_list();
  JointTrace trace;
  trace.signals.resize(joints.size());  // an effect may have added some
  const Bump bump(windows_.half_width_s, episode.period_s);
  std::vector<LooseJoint> loose;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const auto recorded = std::ranges::find(recorded_joints_, joints[j].name);
    if (recorded != recorded_joints_.end())
      trace.signals[j] =
          episode.joints[static_cast<std::size_t>(recorded - recorded_joints_.begin())];
    Signal& angle = trace.signals[j].angle_rad;
    effects::Acting acting(equipped_.acting, joints[j].name, effects::Seat::joint);
    if (!acting.empty()) {
      const Signal said = angle;
      for (std::size_t k = 0; k < angle.size(); ++k)
        angle[k] = acting.undo(effects::Sense::joint, said[k],
                               {episode.period_s * double(k), episode.period_s, 1,
                                rate_of(said, k, episode.period_s)});
      if (const double width = acting.looseness_rad(); width > 0 && !angle.empty()) {
        loose.push_back({j, width, angle});
        angle = taken_up(angle, width, episode.period_s);
      }
    }
  }
  find_pose(episode, trace, guess);
  find_crossings(episode, trace, loose);
  for (const JointSignals& joint : trace.signals)
    trace.speed_rad_per_s.push_back(bump.rates(joint.angle_rad));
  const auto bends = bend(episode, trace);
  trace.complete = bones_.measured(trace.signals);
  if (trace.complete)
    for (const std::size_t row : rows) {
      Motion& motion = trace.motions.emplace_back(bones_.motion(trace.signals, bump, row));
      for (const Bend& b : bends) {
        const auto [angle, speed, acceleration] = b.states[row];
        motion.joints[b.joint].position[0] = angle;
        motion.joints[b.joint].velocity_rad_per_s[0] = speed;
        motion.acceleration[bones_.first_of(static_cast<int>(b.joint))] = acceleration;
      }
    }
  return trace;
}

/// Adds what a joint's friction and springs take along its coordinates. False: a ball joint rests, or
/// is at its stop.
bool Stages::pass_joint(std::size_t j, const JointReading& reading,
                        Eigen::Ref<Eigen::VectorXd> torque) const {
  const erp::Joint& joint = bones_.joint_list()[j];
  const Eigen::Map<const Eigen::VectorXd> velocity(reading.velocity_rad_per_s.data(),
                                                   torque.size());
  const double speed = velocity.norm();
  effects::Acting acting(equipped_.acting, joint.name, effects::Seat::joint);
  if (torque.size() == 1) torque[0] -= acting.joint_torque(reading.position[0]).value;
  torque += joint.viscous_Nm_s_per_rad * velocity;
  if (torque.size() == 3 && near_stop(reading, joint, speed, windows_.half_width_s)) return false;
  if (speed < resting_rad_per_s) return torque.size() == 1;
  torque += (joint.coulomb_Nm + acting.joint_friction_Nm(speed)) * velocity / speed;
  return true;
}

Eigen::MatrixXd Stages::bones(const Episode&, const JointTrace& joints,
                              std::span<const std::size_t> rows) {
  const auto columns = static_cast<Eigen::Index>(joints.complete ? rows.size() : 0);
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
/// stop have taken their share, and how much they may take.
std::pair<double, double> Stages::leave(const JointTrace& joints, std::size_t j, const Bump& bump,
                                        std::size_t row, double torque_Nm) const {
  const erp::Joint& joint = bones_.joint_list()[j];
  if (joints.signals[j].angle_rad.empty()) return {torque_Nm, 0};
  const Gait gait = this->gait(joints, j, bump, row);
  double band = 0;
  if (gait != Gait::glides) {
    effects::Acting acting(equipped_.acting, joint.name, effects::Seat::joint);
    const double friction = joint.coulomb_Nm + acting.joint_friction_Nm(0);
    band = gait == Gait::rests ? friction : 2 * friction;  // one was taken, may be wrong
    torque_Nm = std::copysign(std::max(0.0, std::abs(torque_Nm) - band), torque_Nm);
  }
  const auto [lowest, highest] = range(joints.signals[j].angle_rad, bump, row);
  const bool above = highest > joint.max_rad - near_stop_rad;
  const bool below = lowest < joint.min_rad + near_stop_rad;
  if (above)
    torque_Nm = std::max(0.0, torque_Nm) +
                stop_Nm_per_rad * std::max(0.0, highest - joint.max_rad - stop_gives_rad);
  if (below)
    torque_Nm = std::min(0.0, torque_Nm) -
                stop_Nm_per_rad * std::max(0.0, joint.min_rad - stop_gives_rad - lowest);
  if (above || below) band = std::numeric_limits<double>::infinity();
  return {torque_Nm, band};
}

void Stages::add_joints(const Episode& episode, Explanation& e) const {
  if (!e.joints->complete) return;
  for (const auto& chain : e.chains)
    if (chain->tension_N.empty()) return;
  const Bump bump(windows_.half_width_s, episode.period_s);
  Eigen::MatrixXd pulls = Eigen::MatrixXd::Zero(e.bones->rows(), e.bones->cols());
  for (std::size_t a = 0; a < e.chains.size(); ++a) {
    const ChainTrace& c = *e.chains[a];
    for (Eigen::Index k = 0; k < pulls.cols(); ++k) {
      const std::size_t row = e.rows[static_cast<std::size_t>(k)];
      const double slope = c.path_slope.empty() ? 1 : c.path_slope[row];
      pulls.col(k) += bump.mean(c.tension_N, row) * slope * e.gradients[a]->col(k);
    }
  }
  const Eigen::MatrixXd torques = *e.bones + pulls;
  const auto& joints = bones_.joint_list();
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const int first = bones_.first_of(static_cast<int>(j)), count = coordinates_of(joints[j].type);
    if (first < 0 || !std::ranges::count(recorded_joints_, joints[j].name)) continue;
    for (int d = first; d < first + count; ++d) {
      Residual residual{effects::Stage::joint, joints[j].name, "Nm", {}, rms(pulls.row(d))};
      for (Eigen::Index k = 0; k < torques.cols(); ++k) {
        const auto [left, band] =
            count == 1 ? leave(*e.joints, j, bump, e.rows[std::size_t(k)], torques(d, k))
                       : std::pair(torques(d, k), 0.0);
        residual.value.push_back(left), residual.band.push_back(band);
      }
      e.residuals.push_back(std::move(residual));
    }
  }
}

}  // namespace sim::residuals
