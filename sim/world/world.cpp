#include "sim/world/world.hpp"

#include <stdexcept>

namespace sim {

World::World(const erp::Robot& robot, const WorldOptions& options)
    : robot_(robot), options_(options), tree_(robot) {
  reset();
}

World::~World() = default;

void World::reset() {
  const xml::Vec3 g = robot_.gravity_m_per_s2();
  const Vec3 gravity(g[0], g[1], g[2]);
  skeleton_ = std::make_unique<BulletSkeleton>(tree_, gravity, options_.lock);
  model_ = std::make_unique<SkeletonModel>(tree_, gravity, options_.lock);
  chains_.clear();
  for (const erp::Actuator& actuator : robot_.actuators) try {
      chains_.push_back(make_chain(actuator));
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument("actuator \"" + actuator.name + "\": " + error.what());
    }
  readings_.assign(chains_.size(), {});
  stretched_.assign(chains_.size(), {});
  const int tendons = static_cast<int>(chains_.size()), n = model_->coordinates();
  solver_ = std::make_unique<TendonSolver>(tendons, n, options_.theta);
  rows_.setZero(tendons, n);
  row_.setZero(n), velocity_.setZero(n), momentum_.setZero(n);
  time_s_ = 0;
  read();
}

World::Chain World::make_chain(const erp::Actuator& actuator) const {
  const Routing routing(actuator.tendon, tree_.names);
  routing.require_outside(poses());
  const PathShape shape = routing.solve(poses());
  return {Motor(robot_.motor_of(actuator), actuator.spindle.radius_m, options_.usual_step_s),
          routing, TendonLaw::at_rest(actuator.tendon, actuator.spindle, shape.length_m),
          MotorState{}, shape};
}

void World::read() {
  for (std::size_t k = 0; k < chains_.size(); ++k) {
    Chain& chain = chains_[k];
    chain.routing.solve(poses(), chain.shape);
    const double rate = length_rate_m_per_s(chain.shape, poses(), twists());
    const MotorState& motor = chain.state;
    readings_[k] = {
        chain.tendon.tension_N(chain.shape.length_m, rate, motor.shaft_rad, motor.speed_rad_per_s),
        chain.shape.length_m,
        motor.current_A,
        motor.speed_rad_per_s,
        motor.shaft_rad,
        chain.tendon.line_m(motor.shaft_rad)};
  }
}

StretchedTendon World::stretched(const Chain& chain) const {
  const double length_rate = length_rate_m_per_s(chain.shape, poses(), twists());
  const double winding = chain.tendon.radius_m * chain.state.speed_rad_per_s;
  return {chain.tendon.stiffness_N_per_m, chain.tendon.damping_N_s_per_m,
          chain.tendon.stretch_m(chain.shape.length_m, chain.state.shaft_rad),
          length_rate + winding, winding};
}

/// The tensions over the next step.
std::span<const double> World::pull(double dt_s) {
  model_->place(joints());
  model_->inertia(inertia_);
  model_->bias(bias_);
  model_->gather_velocity(joints(), velocity_);
  momentum_.noalias() = inertia_ * velocity_;
  momentum_ -= dt_s * bias_;
  for (std::size_t k = 0; k < chains_.size(); ++k) {
    stretched_[k] = stretched(chains_[k]);
    row_.setZero();
    for (const PathPull& pull : chains_[k].shape.pulled())
      model_->add_torques(pull.body, pull.at_m, -pull.direction, row_);
    rows_.row(static_cast<Eigen::Index>(k)) = row_;
  }
  return solver_->solve(inertia_, rows_, momentum_, stretched_, dt_s);
}

void World::step(std::span<const double> voltage_V, double dt_s) {
  if (voltage_V.size() != chains_.size())
    throw std::invalid_argument("the robot has " + std::to_string(chains_.size()) +
                                " actuators, got " + std::to_string(voltage_V.size()) +
                                " voltages");
  const auto tension_N = pull(dt_s);
  for (std::size_t k = 0; k < chains_.size(); ++k) {
    Chain& chain = chains_[k];
    for (const PathPull& pull : chain.shape.pulled())
      skeleton_->push(pull.body, pull.at_m, tension_N[k] * pull.direction);
    chain.state = sim::step(chain.motor, chain.state, voltage_V[k], tension_N[k], dt_s);
  }
  skeleton_->step(dt_s);
  time_s_ += dt_s;
  read();
  for (std::size_t k = 0; k < chains_.size(); ++k) readings_[k].tension_N = tension_N[k];
}

void World::set_joint(int joint, const JointReading& reading) {
  skeleton_->set_joint(joint, reading);
  read();
}

}  // namespace sim
