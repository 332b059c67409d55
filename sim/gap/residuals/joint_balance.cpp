// The stage of the joints: the balance of inverse dynamics, tendons and joint friction.
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

constexpr double no_balance = std::numeric_limits<double>::quiet_NaN();
constexpr double resting_joint_rad_per_s = 0.02;  // a slower joint may stick; chosen
constexpr double near_stop_rad = 0.02;            // within this distance a stop may push; chosen
constexpr double stop_deflection_rad = 0.06;      // largest deflection of a stop; chosen
constexpr double stop_Nm_per_rad = 20;            // slope of the residual beyond it; chosen

/// Smallest and largest value in the window around a row.
std::pair<double, double> range(const Signal& signal, const Bump& bump, std::size_t row) {
  const auto first = signal.begin() + static_cast<std::ptrdiff_t>(row - bump.reach());
  const auto [low, high] =
      std::minmax_element(first, first + static_cast<std::ptrdiff_t>(2 * bump.reach() + 1));
  return {*low, *high};
}

/// Whether the stop of a ball joint may push within the window.
bool near_stop(const JointReading& reading, const erp::Joint& joint, double speed_rad_per_s,
               double half_width_s) {
  const double angle_rad = 2 * std::acos(std::min(1.0, std::abs(reading.position[0])));
  return angle_rad + speed_rad_per_s * half_width_s > joint.max_rad - near_stop_rad;
}

}  // namespace

/// Flexible links have unmeasured joints. The deflection δ of each is simulated with its spring k
/// and damper D, driven by the measured motion q of the other joints:
///
///   I δ̈ = −(τ(q, q̇, q̈, δ, δ̇, 0) + k δ + D δ̇)          τ: inverse dynamics, by the trapezoidal rule
///
/// The measured motion is a mean under windows. Thus the result is a mean and is not averaged
/// again.
std::vector<Stages::Flexion> Stages::flexions(const Episode& episode, JointTrace& trace) {
  std::vector<Flexion> flexions;
  const Bump bump(windows_.half_width_s, episode.period_s);
  const std::size_t reach = 2 * bump.reach() + 1;
  for (std::size_t j = 0; j < trace.signals.size(); ++j) {
    const erp::Joint& joint = bones_.joint_list()[j];
    const int coordinate = bones_.first_of(static_cast<int>(j));
    if (coordinate < 0 || std::ranges::count(recorded_joints_, joint.name)) continue;
    effects::Acting acting(equipped_.acting, joint.name, effects::Seat::joint);
    const double stiffness = -acting.joint_torque(0).slope;
    Signal& angles = trace.signals[j].angle_rad;
    angles.assign(episode.rows, 0.0);
    trace.depends_on_bodies = true;
    if (!(stiffness > 0) || !bones_.measured(trace.signals)) continue;
    auto& states =
        flexions.emplace_back(j, std::vector<std::array<double, 3>>(episode.rows)).states;
    double angle = 0, speed = 0;
    bool started = false;
    for (std::size_t k = reach; k + reach < episode.rows; ++k) {
      Motion motion = bones_.motion(trace.signals, bump, k);
      if (!motion.valid) continue;
      motion.joints[j].position[0] = angle, motion.joints[j].velocity_rad_per_s[0] = speed;
      motion.acceleration[coordinate] = 0;
      const double static_Nm = bones_.inverse(motion)[coordinate];
      if (!started) {
        angle = -static_Nm / stiffness, started = true;
      } else {
        motion.acceleration[coordinate] = 1;
        const double inertia = bones_.inverse(motion)[coordinate] - static_Nm;
        const double half_s = episode.period_s / 2, damping = joint.viscous_Nm_s_per_rad;
        const double total_Nm = static_Nm + stiffness * angle + damping * speed;
        states[k] = {angle, speed, -total_Nm / inertia};
        const double speed_change = -2 * half_s * (total_Nm + half_s * stiffness * speed) /
                                    (inertia + half_s * damping + half_s * half_s * stiffness);
        angle += half_s * (2 * speed + speed_change), speed += speed_change;
      }
      constexpr double largest_deflection_rad = 3;  // chosen: a diverging simulation remains finite
      angles[k] = std::clamp(angle, -largest_deflection_rad, largest_deflection_rad);
    }
  }
  return flexions;
}

JointTrace Stages::joint_trace(const Episode& episode, std::span<const std::size_t> rows,
                               const JointTrace* guess) {
  const auto& joints = bones_.joint_list();
  JointTrace trace;
  trace.signals.resize(joints.size());  // more than recorded if an effect adds joints
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
      const Signal reading = angle;
      for (std::size_t k = 0; k < angle.size(); ++k)
        angle[k] = acting.undo(effects::Sense::joint, reading[k],
                               {episode.period_s * double(k), episode.period_s, 1,
                                rate_of(reading, k, episode.period_s)});
      if (const double width = acting.play_rad(); width > 0 && !angle.empty()) {
        loose.push_back({j, width, angle});
        angle = without_play(angle, width, episode.period_s);
      }
    }
  }
  find_pose(episode, trace, guess);
  find_crossings(episode, trace, loose);
  for (const JointSignals& joint : trace.signals)
    trace.speed_rad_per_s.push_back(bump.rates(joint.angle_rad));
  const auto flexions = this->flexions(episode, trace);
  trace.complete = bones_.measured(trace.signals);
  if (trace.complete)
    for (const std::size_t row : rows) {
      Motion& motion = trace.motions.emplace_back(bones_.motion(trace.signals, bump, row));
      for (const Flexion& b : flexions) {
        const auto [angle, speed, acceleration] = b.states[row];
        motion.joints[b.joint].position[0] = angle;
        motion.joints[b.joint].velocity_rad_per_s[0] = speed;
        motion.acceleration[bones_.first_of(static_cast<int>(b.joint))] = acceleration;
      }
    }
  return trace;
}

/// Adds the torques of a joint's friction and springs along its coordinates. Returns false if a
/// ball joint rests or is at its stop.
bool Stages::add_joint_torque(std::size_t j, const JointReading& reading,
                              Eigen::Ref<Eigen::VectorXd> torque) const {
  const erp::Joint& joint = bones_.joint_list()[j];
  const Eigen::Map<const Eigen::VectorXd> velocity(reading.velocity_rad_per_s.data(),
                                                   torque.size());
  const double speed = velocity.norm();
  effects::Acting acting(equipped_.acting, joint.name, effects::Seat::joint);
  if (torque.size() == 1) torque[0] -= acting.joint_torque(reading.position[0]).value;
  torque += joint.viscous_Nm_s_per_rad * velocity;
  if (torque.size() == 3 && near_stop(reading, joint, speed, windows_.half_width_s)) return false;
  if (speed < resting_joint_rad_per_s) return torque.size() == 1;
  torque += (joint.coulomb_Nm + acting.joint_friction_Nm(speed)) * velocity / speed;
  return true;
}

Eigen::MatrixXd Stages::bones(const Episode&, const JointTrace& joints,
                              std::span<const std::size_t> rows) {
  const auto columns = static_cast<Eigen::Index>(joints.complete ? rows.size() : 0);
  Eigen::MatrixXd torques = Eigen::MatrixXd::Constant(bones_.coordinates(), columns, no_balance);
  for (Eigen::Index k = 0; k < columns; ++k) {
    const Motion& motion = joints.motions[static_cast<std::size_t>(k)];
    if (!motion.valid) continue;
    Eigen::VectorXd torque = bones_.inverse(motion);
    for (std::size_t j = 0; j < motion.joints.size(); ++j) {
      const int first = bones_.first_of(static_cast<int>(j));
      if (first < 0) continue;
      auto part = torque.segment(first, coordinates_of(motion.joints[j].type));
      if (!add_joint_torque(j, motion.joints[j], part)) part.setConstant(no_balance);
    }
    torques.col(k) = torque;
  }
  return torques;
}

Stages::Mobility Stages::mobility(const JointTrace& joints, std::size_t j, const Bump& bump,
                                  std::size_t row) const {
  const auto [slowest, fastest] = range(joints.speed_rad_per_s[j], bump, row);
  if (slowest > resting_joint_rad_per_s || fastest < -resting_joint_rad_per_s)
    return Mobility::moves;
  const double mean = bump.rate(joints.signals[j].angle_rad, row);
  const bool is_still = std::max(-slowest, fastest) < resting_joint_rad_per_s;
  return is_still && std::abs(mean) < resting_joint_rad_per_s ? Mobility::rests : Mobility::mixed;
}

/// The part of a revolute joint's balance that neither friction at rest nor a stop can explain, and
/// the band of torque that these may balance.
std::pair<double, double> Stages::remaining_torque(const JointTrace& joints, std::size_t j,
                                                   const Bump& bump, std::size_t row,
                                                   double torque_Nm) const {
  const erp::Joint& joint = bones_.joint_list()[j];
  if (joints.signals[j].angle_rad.empty()) return {torque_Nm, 0};
  const Mobility mobility = this->mobility(joints, j, bump, row);
  double band = 0;
  if (mobility != Mobility::moves) {
    effects::Acting acting(equipped_.acting, joint.name, effects::Seat::joint);
    const double friction = joint.coulomb_Nm + acting.joint_friction_Nm(0);
    // In mixed windows the balance already contains friction of one sign, which may be wrong.
    band = mobility == Mobility::rests ? friction : 2 * friction;
    torque_Nm = std::copysign(std::max(0.0, std::abs(torque_Nm) - band), torque_Nm);
  }
  const auto [lowest, highest] = range(joints.signals[j].angle_rad, bump, row);
  const bool above = highest > joint.max_rad - near_stop_rad;
  const bool below = lowest < joint.min_rad + near_stop_rad;
  if (above)
    torque_Nm = std::max(0.0, torque_Nm) +
                stop_Nm_per_rad * std::max(0.0, highest - joint.max_rad - stop_deflection_rad);
  if (below)
    torque_Nm = std::min(0.0, torque_Nm) -
                stop_Nm_per_rad * std::max(0.0, joint.min_rad - stop_deflection_rad - lowest);
  if (above || below) band = std::numeric_limits<double>::infinity();
  return {torque_Nm, band};
}

void Stages::add_joints(const Episode& episode, Explanation& e) const {
  if (!e.joints->complete) return;
  for (const auto& chain : e.chains)
    if (chain->tension_N.empty()) return;
  const Bump bump(windows_.half_width_s, episode.period_s);
  Eigen::MatrixXd tendon_torques = Eigen::MatrixXd::Zero(e.bones->rows(), e.bones->cols());
  for (std::size_t a = 0; a < e.chains.size(); ++a) {
    const ChainTrace& c = *e.chains[a];
    for (Eigen::Index k = 0; k < tendon_torques.cols(); ++k) {
      const std::size_t row = e.rows[static_cast<std::size_t>(k)];
      const double slope = c.path_slope.empty() ? 1 : c.path_slope[row];
      tendon_torques.col(k) += bump.mean(c.tension_N, row) * slope * e.gradients[a]->col(k);
    }
  }
  const Eigen::MatrixXd torques = *e.bones + tendon_torques;
  const auto& joints = bones_.joint_list();
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const int first = bones_.first_of(static_cast<int>(j)), count = coordinates_of(joints[j].type);
    if (first < 0 || !std::ranges::count(recorded_joints_, joints[j].name)) continue;
    for (int d = first; d < first + count; ++d) {
      Residual residual{
          effects::Stage::joint, joints[j].name, "Nm", {}, rms(tendon_torques.row(d))};
      for (Eigen::Index k = 0; k < torques.cols(); ++k) {
        const auto [remaining, band] =
            count == 1 ? remaining_torque(*e.joints, j, bump, e.rows[std::size_t(k)], torques(d, k))
                       : std::pair(torques(d, k), 0.0);
        residual.value.push_back(remaining), residual.band.push_back(band);
      }
      e.residuals.push_back(std::move(residual));
    }
  }
}

}  // namespace sim::residuals
