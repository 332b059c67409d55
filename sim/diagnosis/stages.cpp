#include "sim/diagnosis/stages.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sim/diagnosis/chain_trace.hpp"

namespace sim::diagnosis {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double resting_rad_per_s = 0.02;  // chosen: a joint slower than this may stick
constexpr double near_stop_rad = 0.02;      // chosen: its stop may push

}  // namespace

struct Stages::View {
  const Episode& episode;
  std::vector<JointSignals> joints;  ///< sensors undone
  std::vector<ChainTrace> chains;
  std::vector<std::size_t> rows;
  std::vector<Signal> speed_rad_per_s{};  ///< of revolute joints
};

Stages::Stages(const erp::Robot& robot, const Windows& windows)
    : equipped_(effects::equip(robot)), windows_(windows), bones_(equipped_.robot) {
  for (const erp::Joint& joint : robot.joints()) recorded_joints_.push_back(joint.name);
}

std::vector<std::size_t> Stages::rows(const Episode& episode) const {
  const std::size_t reach = 2 * Bump(windows_.half_width_s, episode.period_s).reach() + 1;
  const auto stride = static_cast<std::size_t>(
      std::max<long>(1, std::lround(windows_.stride_s / episode.period_s)));
  std::vector<std::size_t> rows;
  for (std::size_t k = reach; k + reach < episode.rows; k += stride) rows.push_back(k);
  return rows;
}

std::vector<JointSignals> Stages::undone(const Episode& episode) const {
  std::vector<JointSignals> joints(bones_.joint_list().size());  // an effect may have added some
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const auto recorded = std::ranges::find(recorded_joints_, bones_.joint_list()[j].name);
    if (recorded != recorded_joints_.end())
      joints[j] = episode.joints[static_cast<std::size_t>(recorded - recorded_joints_.begin())];
    effects::Acting acting(equipped_.acting, bones_.joint_list()[j].name, effects::Seat::joint);
    if (acting.empty()) continue;
    Signal& angle = joints[j].angle_rad;
    for (std::size_t k = 0; k < angle.size(); ++k)
      angle[k] = acting.undo(effects::Sense::joint, angle[k],
                             {episode.period_s * double(k), episode.period_s, 1});
  }
  return joints;
}

std::vector<Residual> Stages::residuals(const Episode& episode) {
  View view{episode, undone(episode), {}, rows(episode)};
  const auto paths = bones_.paths(view.joints, episode.rows);
  const erp::Robot& robot = equipped_.robot;
  for (std::size_t a = 0; a < robot.actuators.size(); ++a) {
    const erp::Actuator& actuator = robot.actuators[a];
    view.chains.push_back(
        trace({robot.motor_of(actuator), actuator,
               effects::Acting(equipped_.acting, actuator.name, effects::Seat::actuator),
               bones_.start_m(a)},
              episode.actuators[a], paths[a], episode.period_s, windows_.speed_half_width_s));
  }
  std::vector<Residual> all;
  for (std::size_t a = 0; a < robot.actuators.size(); ++a) {
    add_motor(view, a, all);
    add_gearbox(view, a, all);
    add_tendon(view, a, all);
  }
  add_joints(view, all);
  return all;
}

Residual Stages::under_windows(const View& view, effects::Stage stage, const std::string& on,
                               const char* unit,
                               const std::function<double(const Bump&, std::size_t)>& at) const {
  const Bump bump(windows_.half_width_s, view.episode.period_s);
  Residual residual{stage, on, unit, {}};
  for (const std::size_t row : view.rows) residual.value.push_back(at(bump, row));
  return residual;
}

void Stages::add_motor(const View& view, std::size_t a, std::vector<Residual>& all) const {
  const ChainTrace& c = view.chains[a];
  if (!c.current_measured || c.terminal_V.empty()) return;
  const erp::Actuator& actuator = equipped_.robot.actuators[a];
  const erp::MotorType& m = equipped_.robot.motor_of(actuator);
  Signal left(c.terminal_V.size(), nan);
  for (std::size_t k = 1; k < left.size(); ++k) {
    // of the current before, so much is left at the end of a period
    const double kept = std::exp(-view.episode.period_s * c.resistance_ohm[k] / m.inductance_H);
    const double settled_A = (c.current_A[k] - kept * c.current_A[k - 1]) / (1 - kept);
    left[k] = c.terminal_V[k] - c.resistance_ohm[k] * settled_A;
  }
  const double back_emf = m.back_emf_V_s_per_rad * m.gear_ratio;
  all.push_back(under_windows(
      view, effects::Stage::motor, actuator.name, "V", [&](const Bump& bump, std::size_t k) {
        const double lag_s = m.inductance_H / bump.mean(c.resistance_ohm, k);
        return bump.mean(left, k) -
               back_emf * (bump.rate(c.shaft_rad, k) - lag_s * bump.acceleration(c.shaft_rad, k));
      }));
}

void Stages::add_gearbox(const View& view, std::size_t a, std::vector<Residual>& all) const {
  const ChainTrace& c = view.chains[a];
  if (c.drive_Nm.empty()) return;
  const erp::Actuator& actuator = equipped_.robot.actuators[a];
  erp::MotorType motor = equipped_.robot.motor_of(actuator);
  const double viscous = motor.rotor_viscous_Nm_s_per_rad * motor.gear_ratio * motor.gear_ratio;
  all.push_back(under_windows(
      view, effects::Stage::gearbox, actuator.name, "Nm", [&](const Bump& bump, std::size_t k) {
        if (!c.resistance_ohm.empty()) motor.resistance_ohm = bump.mean(c.resistance_ohm, k);
        const double inertia = balance_inertia(motor, view.episode.period_s);
        return inertia * bump.acceleration(c.shaft_rad, k) + viscous * bump.rate(c.shaft_rad, k) -
               bump.mean(c.drive_Nm, k);
      }));
}

void Stages::add_tendon(const View& view, std::size_t a, std::vector<Residual>& all) const {
  const ChainTrace& c = view.chains[a];
  if (!c.tension_measured || c.spring_N.empty()) return;
  all.push_back(under_windows(view, effects::Stage::tendon, equipped_.robot.actuators[a].name, "N",
                              [&](const Bump& bump, std::size_t k) {
                                return bump.mean(c.tension_N, k) - bump.mean(c.spring_N, k);
                              }));
}

/// What a joint's friction and springs leave of the balance along its coordinates; false: it rests.
bool Stages::pass_joint(std::size_t j, const JointReading& reading,
                        Eigen::Ref<Eigen::VectorXd> torque) const {
  const erp::Joint& joint = bones_.joint_list()[j];
  const Eigen::Map<const Eigen::VectorXd> velocity(reading.velocity_rad_per_s.data(),
                                                   torque.size());
  const double speed = velocity.norm();
  if (speed < resting_rad_per_s) return false;
  effects::Acting acting(equipped_.acting, joint.name, effects::Seat::joint);
  torque += joint.viscous_Nm_s_per_rad * velocity +
            (joint.coulomb_Nm + acting.joint_friction_Nm(speed)) * velocity / speed;
  if (torque.size() != 1) return true;
  torque[0] -= acting.joint_torque(reading.position[0]).value;
  return true;
}

/// All over the window a revolute joint glides one way, off its stops.
bool Stages::glides(const View& view, std::size_t j, const Bump& bump, std::size_t row) const {
  if (view.joints[j].angle_rad.empty()) return true;
  const erp::Joint& joint = bones_.joint_list()[j];
  const auto range = [&](const Signal& signal) {
    const auto first = signal.begin() + static_cast<std::ptrdiff_t>(row - bump.reach());
    return std::minmax_element(first, first + static_cast<std::ptrdiff_t>(2 * bump.reach() + 1));
  };
  const auto [lowest, highest] = range(view.joints[j].angle_rad);
  const auto [slowest, fastest] = range(view.speed_rad_per_s[j]);
  return *lowest > joint.min_rad + near_stop_rad && *highest < joint.max_rad - near_stop_rad &&
         (*slowest > resting_rad_per_s || *fastest < -resting_rad_per_s);
}

void Stages::add_joints(View& view, std::vector<Residual>& all) {
  if (!bones_.measured(view.joints)) return;
  for (const ChainTrace& c : view.chains)
    if (c.tension_N.empty()) return;
  const Bump bump(windows_.half_width_s, view.episode.period_s);
  for (const JointSignals& joint : view.joints)
    view.speed_rad_per_s.push_back(bump.rates(joint.angle_rad));
  const std::size_t first = all.size();
  const auto& joints = bones_.joint_list();
  for (std::size_t j = 0; j < joints.size(); ++j)
    for (int d = 0; d < coordinates_of(joints[j].type) && bones_.first_of(int(j)) >= 0; ++d)
      all.push_back({effects::Stage::joint, joints[j].name, "Nm", {}});
  for (const std::size_t row : view.rows) {
    const Motion motion = bones_.motion(view.joints, bump, row);
    Eigen::VectorXd torque = Eigen::VectorXd::Constant(bones_.coordinates(), nan);
    if (motion.taken) torque = balance(view, motion, bump, row);
    for (std::size_t r = first, c = 0; r < all.size(); ++r, ++c)
      all[r].value.push_back(torque[static_cast<int>(c)]);
  }
}

Eigen::VectorXd Stages::balance(const View& view, const Motion& motion, const Bump& bump,
                                std::size_t row) {
  Eigen::VectorXd torque = bones_.inverse(motion);
  for (std::size_t a = 0; a < view.chains.size(); ++a) {
    const ChainTrace& c = view.chains[a];
    const double slope = c.path_slope.empty() ? 1 : c.path_slope[row];
    torque += bump.mean(c.tension_N, row) * slope * bones_.gradient(a);
  }
  for (std::size_t j = 0; j < motion.joints.size(); ++j) {
    const int first = bones_.first_of(static_cast<int>(j));
    if (first < 0) continue;
    auto part = torque.segment(first, coordinates_of(motion.joints[j].type));
    if (!pass_joint(j, motion.joints[j], part) || !glides(view, j, bump, row))
      part.setConstant(nan);
  }
  return torque;
}

}  // namespace sim::diagnosis
