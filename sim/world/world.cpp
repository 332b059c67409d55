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
  skeleton_ = std::make_unique<BulletSkeleton>(tree_, Vec3(g[0], g[1], g[2]), options_.lock);
  chains_.clear();
  for (const erp::Actuator& actuator : robot_.actuators) try {
      chains_.push_back(make_chain(actuator));
    } catch (const std::invalid_argument& error) {
      throw std::invalid_argument("actuator \"" + actuator.name + "\": " + error.what());
    }
  readings_.assign(chains_.size(), {});
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

void World::step(std::span<const double> voltage_V, double dt_s) {
  if (voltage_V.size() != chains_.size())
    throw std::invalid_argument("the robot has " + std::to_string(chains_.size()) +
                                " actuators, got " + std::to_string(voltage_V.size()) +
                                " voltages");
  for (std::size_t k = 0; k < chains_.size(); ++k) {
    Chain& chain = chains_[k];
    const double tension_N = readings_[k].tension_N;
    for (const PathPull& pull : chain.shape.pulled())
      skeleton_->push(pull.body, pull.at_m, tension_N * pull.direction);
    chain.state = sim::step(chain.motor, chain.state, voltage_V[k], tension_N, dt_s);
  }
  skeleton_->step(dt_s);
  time_s_ += dt_s;
  read();
}

void World::set_joint(int joint, const JointReading& reading) {
  skeleton_->set_joint(joint, reading);
  read();
}

}  // namespace sim
