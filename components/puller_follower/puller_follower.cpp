#include "components/puller_follower/puller_follower.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>
#include <utility>

namespace control {
namespace {

constexpr double rest_rad_per_s = 0.15, rest_s = 0.1;  // chosen: braked for longer than it swings
constexpr double creeping_rad_per_s = 0.02;  // chosen: below, Coulomb friction is taken as viscous

/// τ_f at the wanted speed, so that it does not chatter.
double friction_Nm(const sim::loop_shaping::Hinge& hinge, double wanted_rad_per_s) {
  const double turning = std::max(std::abs(wanted_rad_per_s), creeping_rad_per_s);
  return (hinge.viscous_Nm_s_per_rad + hinge.coulomb_Nm / turning) * wanted_rad_per_s;
}

/// With the shape of its loops read.
PullerFollower::Params complete(PullerFollower::Params params) {
  if (params.drives.high_N < params.drives.low_N)
    throw std::invalid_argument("high_N is the reference tension at a change of roles: give " +
                                std::to_string(params.drives.low_N) + " or more");
  if (params.law != Law::loop_shaping || params.loops.empty()) return params;
  const auto folder = std::filesystem::path(params.place.file).parent_path();
  params.laws.shape = xml::read<sim::loop_shaping::JointShape>((folder / params.loops).string());
  params.drives.smooth_s = params.laws.shape.smooth_s;
  return params;
}

}  // namespace

PullerFollower::PullerFollower(const Params& params, const erp::Robot& robot)
    : params_(complete(params)),
      names_(robot),
      model_(robot),
      hinges_(sim::loop_shaping::hinges_of(model_)),
      now_(names_.size()),
      wanted_(names_.size()),
      held_(names_.size()),
      errors_(model_.coordinates()),
      dynamics_(model_.coordinates()),
      factor_(model_.coordinates()),
      acting_Nm_(Eigen::VectorXd::Zero(model_.coordinates())),
      torque_Nm_(acting_Nm_),
      friction_Nm_(acting_Nm_),
      acceleration_(acting_Nm_),
      unmodelled_(model_.coordinates()) {
  for (const auto& hinge : hinges_) drives_.emplace_back(robot, model_, hinge, params_.drives);
  law_ = law_of(params_.law, params_.laws, model_);
}

std::optional<erp::ActuatorCommand> PullerFollower::step(
    const erp::SensorFrame& frame, double dt_s, const node::Latest<erp::JointState>& state,
    const node::Latest<erp::JointTarget>& target) {
  const bool heard = hear(frame, dt_s);
  const bool known = heard && state && state.age_s <= params_.stale_s &&
                     names_.read(state.message, frame.stamp_ns, now_) && target &&
                     target.age_s <= params_.stale_s &&
                     names_.read(target.message, frame.stamp_ns, wanted_);
  const Phase before = std::exchange(phase_, known ? next() : Phase::silent);
  if (!known) return std::nullopt;
  const bool goes_on = phase_ == before && dt_s <= params_.stale_s;
  model_.place(now_);
  return phase_ == Phase::brakes ? brake(goes_on, dt_s) : lead(goes_on, dt_s);
}

PullerFollower::Phase PullerFollower::next() const {
  const bool still_brakes = phase_ == Phase::brakes && rested_s_ < rest_s;
  if (still_brakes || std::ranges::any_of(drives_, &JointDrive::outrun)) return Phase::brakes;
  return std::ranges::any_of(drives_, &JointDrive::hangs) ? Phase::holds : Phase::leads;
}

erp::ActuatorCommand PullerFollower::brake(bool goes_on, double dt_s) {
  if (!goes_on) {
    say_outrun();
    std::ranges::for_each(drives_, &JointDrive::stop);
    rested_s_ = 0;
  }
  const bool rests = model_.skeleton().velocity().cwiseAbs().maxCoeff() < rest_rad_per_s;
  rested_s_ = rests ? rested_s_ + dt_s : 0;
  erp::ActuatorCommand command;
  for (const JointDrive& drive : drives_) drive.brake(model_, command);
  return command;
}

void PullerFollower::say_outrun() const {
  if (!node_) return;
  for (std::size_t k = 0; k < drives_.size(); ++k)
    if (drives_[k].outrun())
      node_->report(erp::Severity::warning, hinges_[k].name, "outrun",
                    "asks more of its motors than they have: braked until all joints are at rest, "
                    "then led on");
}

erp::ActuatorCommand PullerFollower::lead(bool goes_on, double dt_s) {
  const double since_s = goes_on ? dt_s : 0;
  dynamics_.take(model_.skeleton());
  for (std::size_t k = 0; k < drives_.size(); ++k)
    acting_Nm_[hinges_[k].coordinate] = drives_[k].torque_Nm(model_);
  if (!goes_on) begin();
  led_s_ += since_s;
  if (phase_ == Phase::holds) std::ranges::copy(held_, wanted_.begin());
  else onto_target_.add(led_s_, wanted_);
  compare();
  find_torques(since_s);
  find_acceleration(since_s);
  erp::ActuatorCommand command;
  for (std::size_t k = 0; k < drives_.size(); ++k) {
    const int at = hinges_[k].coordinate;
    if (!goes_on) drives_[k].begin(torque_Nm_[at]);
    drives_[k].drive(torque_Nm_[at], acceleration_[at], model_, since_s, command);
  }
  return command;
}

bool PullerFollower::hear(const erp::SensorFrame& frame, double dt_s) {
  bool all = true;
  for (JointDrive& drive : drives_) all = drive.hear(frame, dt_s) && all;
  return all;
}

void PullerFollower::begin() {
  law_->begin(acting_Nm_, dynamics_);
  led_s_ = 0;
  onto_target_ = joints::onto(now_, wanted_, params_.start_rad_per_s);
  for (std::size_t j = 0; j < now_.size(); ++j) {
    held_[j].now = now_[j];
    held_[j].now.velocity_rad_per_s = {};
  }
}

void PullerFollower::compare() {
  for (const auto& hinge : hinges_) {
    const auto joint = static_cast<std::size_t>(hinge.joint);
    const int at = hinge.coordinate;
    const sim::JointMotion& wanted = wanted_[joint];
    const sim::JointReading& now = now_[joint];
    errors_.error_rad[at] = wanted.now.position[0] - now.position[0];
    errors_.wanted_rad_per_s[at] = wanted.now.velocity_rad_per_s[0];
    errors_.error_rad_per_s[at] = errors_.wanted_rad_per_s[at] - now.velocity_rad_per_s[0];
    errors_.wanted_rad_per_s2[at] = wanted.acceleration_rad_per_s2[0];
  }
}

void PullerFollower::find_torques(double dt_s) {
  torque_Nm_ = law_->torque_Nm(errors_, dynamics_, dt_s);
  for (const auto& hinge : hinges_) {
    const int at = hinge.coordinate;
    friction_Nm_[at] = friction_Nm(hinge, errors_.wanted_rad_per_s[at]);
  }
  torque_Nm_ += params_.friction * friction_Nm_;
}

/// Under the torque asked for; what is unmodelled, from the one that acts. `dt_s` 0: control begins.
void PullerFollower::find_acceleration(double dt_s) {
  factor_.compute(dynamics_.inertia);
  const auto by_model = [&](const Eigen::VectorXd& torque_Nm) -> const Eigen::VectorXd& {
    acceleration_ = torque_Nm - dynamics_.bias - friction_Nm_;
    factor_.solveInPlace(acceleration_);
    return acceleration_;
  };
  const Eigen::VectorXd& speed = model_.skeleton().velocity();
  if (dt_s > 0) unmodelled_.see(speed, by_model(acting_Nm_), dt_s);
  else unmodelled_.begin(speed, by_model(acting_Nm_));
  by_model(torque_Nm_);
  acceleration_ += unmodelled_.acceleration_rad_per_s2();
}

}  // namespace control
