#include "sim/world/world.hpp"

#include <algorithm>
#include <stdexcept>

#include "sim/model/actuator/with_actuator_name.hpp"
#include "sim/model/effects/library.hpp"

namespace sim {

World::World(const erp::Robot& robot, const WorldOptions& options)
    : equipped_(std::make_shared<effects::Equipped>(effects::equip(robot))),
      robot_(equipped_->robot),
      options_(options),
      tree_(robot_) {
  reset();
}

World::~World() = default;

void World::reset() {
  const xml::Vec3 g = robot_.gravity_m_per_s2();
  const Vec3 gravity(g[0], g[1], g[2]);
  bones_ = std::make_unique<BulletSkeleton>(tree_, gravity, options_.lock);
  model_ = std::make_unique<SkeletonModel>(tree_, gravity, options_.lock);
  chains_.clear();
  for (const erp::Actuator& actuator : robot_.actuators)
    chains_.push_back(with_actuator_name(actuator, [&] { return make_chain(actuator); }));
  readings_.assign(chains_.size(), {});
  attached_.clear();
  make_solver();
  time_s_ = time_remainder_s_ = 0;
  unconverged_steps_ = 0, finite_ = true;
  read();
  make_ropes();
  read_tensions();
}

World::Chain World::make_chain(const erp::Actuator& actuator) const {
  const Routing routing(actuator.tendon, tree_.names);
  routing.require_outside(poses());
  const PathShape shape = routing.solve(poses());
  return {Motor(robot_.motor_of(actuator), actuator.spindle.radius_m, options_.usual_step_s),
          routing,
          levers_of(routing, *model_),
          TendonLaw::at_rest(actuator.tendon, actuator.spindle, shape.length_m),
          MotorState{},
          shape,
          nullptr,
          effects::Acting(equipped_->acting, actuator.name, effects::Seat::actuator),
          {0, actuator.spindle.radius_m},
          shape.length_m,
          robot_.motor_of(actuator).resistance_ohm};
}

void World::make_solver() {
  std::vector<JointFriction> frictions;
  joint_effects_.clear();
  for (int j = 0; j < static_cast<int>(tree_.joints.size()); ++j)
    if (const erp::Joint& joint = tree_.joints[j];
        model_->first_of(j) >= 0 && joint.type != erp::JointType::free) {
      const int first = model_->first_of(j), dofs = coordinates_of(joint.type);
      effects::Acting acting(equipped_->acting, joint.name, effects::Seat::joint);
      if (!acting.empty())
        joint_effects_.push_back(
            {j, first, dofs, frictions.size(), joint.coulomb_Nm, std::move(acting)});
      frictions.push_back({first, dofs, joint.viscous_Nm_s_per_rad, joint.coulomb_Nm});
    }
  const int n = model_->coordinates();
  limits_ = std::make_unique<JointLimits>(*model_, tree_.joints);
  contacts_ = std::make_unique<Contacts>(tree_, robot_);
  forces_.resize(chains_.size() +
                 static_cast<std::size_t>(limits_->max_count() + contacts_->max_count()));
  for (OneSidedForce& force : forces_) force.row.reserve(static_cast<std::size_t>(n));
  solver_ = std::make_unique<StepSolver>(n, static_cast<int>(forces_.size()), frictions);
  for (auto* vector : {&row_, &velocity_, &momentum_, &right_side_, &mid_velocity_})
    vector->setZero(n);
  inertia_factor_.resize(n);
}

void World::read() {
  model_->place(joints());
  for (std::size_t k = 0; k < chains_.size(); ++k) {
    Chain& chain = chains_[k];
    chain.routing.solve(poses(), chain.shape);
    const MotorState& motor = chain.state;
    readings_[k] = {
        readings_[k].tension_N,
        chain.rope ? chain.rope->length_m() : chain.shape.length_m,
        motor.current_A,
        motor.speed_rad_per_s,
        motor.shaft_rad,
        chain.effects.empty() ? chain.tendon.line_m(motor.shaft_rad) : -chain.wound.value};
  }
}

double World::current_tension_N(std::size_t k) {
  const Chain& chain = chains_[k];
  if (chain.rope) return chain.rope->tension_N();
  if (chain.snapped) return 0;
  const double rate = length_rate_m_per_s(chain.shape, poses(), twists());
  const double speed = chain.state.speed_rad_per_s;
  if (chain.effects.empty())
    return chain.tendon.tension_N(chain.shape.length_m, rate, chain.state.shaft_rad, speed);
  const LineState line = line_state(k, 0);
  if (line.stretch_m <= 0) return 0;
  const double stretching_m_per_s = line.path_slope * rate + chain.wound.slope * speed;
  return std::max(0.0, chain.tendon.spring.force_N(line.stretch_m) + line.effects_pull.value +
                           chain.tendon.damping_N_s_per_m * stretching_m_per_s);
}

void World::read_tensions() {
  for (std::size_t k = 0; k < chains_.size(); ++k) readings_[k].tension_N = current_tension_N(k);
}

void World::set_tendon_force(std::size_t k, double dt_s) {
  Chain& chain = chains_[k];
  OneSidedForce& force = forces_[k];
  force.row.clear();
  if (chain.rope) return void(force.start_N = 0);
  length_gradient(chain.shape, chain.levers, *model_, row_);
  const LineState line = line_state(k, dt_s);
  if (line.path_slope != 1) row_ *= line.path_slope;
  for (const int d : chain.levers.coordinates)
    if (row_[d] != 0) force.row.push_back({d, row_[d]});
  const double winding_m_per_s = chain.wound.slope * chain.state.speed_rad_per_s;
  StretchedTendon tendon =
      stretched(chain.tendon, line.stretch_m, row_.dot(model_->velocity()) + winding_m_per_s,
                winding_m_per_s);
  tendon.spring_N += line.effects_pull.value, tendon.stiffness_N_per_m += line.effects_pull.slope;
  Implicitness theta{options_.theta, options_.theta};
  if (options_.theta == 0)
    theta = implicitness_of(tendon, inertia_factor_.inverse_norm2(row_), dt_s);
  pull_implicitly(tendon, theta, dt_s, force);
}

/// Forces of the joint limits, the contacts and, with `springs`, the tendons.
void World::find_forces(double dt_s, bool springs) {
  const std::size_t tendons = springs ? chains_.size() : 0;
  if (springs && options_.theta == 0) inertia_factor_.compute(inertia_);
  for (std::size_t k = 0; k < tendons; ++k) set_tendon_force(k, dt_s);
  force_count_ = tendons;
  const auto free_forces = [this] { return std::span(forces_).subspan(force_count_); };
  force_count_ += static_cast<std::size_t>(limits_->find(joints(), inertia_, dt_s, free_forces()));
  force_count_ += static_cast<std::size_t>(contacts_->find(*model_, dt_s, free_forces()));
}

/// Computes v⁺, with springs or with given tensions.
void World::solve(double dt_s, std::span<const double> tension_N) {
  const Eigen::VectorXd& v = model_->velocity();
  model_->inertia(inertia_);
  find_forces(dt_s, tension_N.empty());
  set_joint_friction();
  solver_->begin(inertia_, std::span(forces_).first(force_count_), dt_s);
  momentum_.noalias() = inertia_ * v;
  for (std::size_t k = 0; k < tension_N.size(); ++k) {
    length_gradient(chains_[k].shape, chains_[k].levers, *model_, row_);
    momentum_ -= dt_s * tension_N[k] * line_state(k, dt_s).path_slope * row_;
  }
  if (tension_N.empty()) add_rope_impulses(dt_s);
  for (JointEffects& joint : joint_effects_)
    momentum_.segment(joint.first, joint.dofs) += dt_s * torque_of(joint);
  velocity_ = v;
  if (!finite_) return velocity_.setZero(), void();
  apply_bias(dt_s);
  solver_->approach(right_side_, velocity_);  // v¹; an estimate is sufficient
  apply_bias(dt_s);
  if (!solver_->solve(right_side_, velocity_)) ++unconverged_steps_;
  if (velocity_.allFinite()) return;
  finite_ = false;
  velocity_.setZero();
}

/// H v − dt b, with b at the mean of v and the current estimate of v⁺.
void World::apply_bias(double dt_s) {
  mid_velocity_ = 0.5 * (model_->velocity() + velocity_);
  model_->bias(mid_velocity_, bias_);
  right_side_ = momentum_ - dt_s * bias_;
}

void World::check_size(std::span<const double> inputs, const char* what) const {
  if (inputs.size() != chains_.size())
    throw std::invalid_argument("the robot has " + std::to_string(chains_.size()) +
                                " actuators, got " + std::to_string(inputs.size()) + " " + what);
}

void World::step(std::span<const double> voltage_V, double dt_s) {
  check_size(voltage_V, "voltages");
  solve(dt_s);
  for (std::size_t k = 0; k < chains_.size(); ++k) {
    const double tension_N =
        chains_[k].rope ? chains_[k].rope->tension_N() : solver_->forces_N()[k];
    readings_[k].tension_N = tension_N;
    turn_motor(k, voltage_V[k], tension_N, dt_s);
  }
  move(dt_s);
  read_tensions();
}

void World::step_pulled(std::span<const double> tension_N, double dt_s) {
  check_size(tension_N, "tensions");
  solve(dt_s, tension_N);
  for (std::size_t k = 0; k < chains_.size(); ++k) readings_[k].tension_N = tension_N[k];
  move(dt_s);
}

void World::move(double dt_s) {
  bones_->move(velocity_, dt_s);
  advance_time(dt_s);
  read();
  move_ropes(dt_s);
}

/// Compensated summation (Kahan 1965): after an hour of 1 ms steps the time is still exact to
/// rounding.
void World::advance_time(double dt_s) {
  const double step_s = dt_s - time_remainder_s_, next_s = time_s_ + step_s;
  time_remainder_s_ = (next_s - time_s_) - step_s;
  time_s_ = next_s;
}

void World::attach(std::vector<AttachedMass> attached) {
  for (const AttachedMass& mass : attached) {
    const int joint = tree_.bodies.at(static_cast<std::size_t>(mass.body)).joint;
    const auto type =
        joint < 0 ? erp::JointType::fixed : tree_.joints[static_cast<std::size_t>(joint)].type;
    if (type != erp::JointType::revolute && type != erp::JointType::spherical)
      throw std::invalid_argument("body \"" + tree_.names[static_cast<std::size_t>(mass.body)] +
                                  "\" cannot hold a load: no hinge or ball joint moves it");
  }
  attached_ = std::move(attached);
  for (std::size_t k = 0; k < tree_.bodies.size(); ++k) {
    erp::Mass mass = tree_.bodies[k].mass;
    for (const AttachedMass& added : attached_)
      if (added.body == static_cast<int>(k))
        mass = erp::combined(
            {mass, {added.mass_kg, {added.at_m[0], added.at_m[1], added.at_m[2]}, {}}});
    model_->set_mass(static_cast<int>(k), mass);
  }
  model_->place(joints());
}

void World::set_joint(int joint, const JointReading& reading) {
  std::vector<JointReading> all(joints().begin(), joints().end());
  all[static_cast<std::size_t>(joint)] = reading;
  bones_->place(all);
  read();
  for (std::size_t k = 0; k < chains_.size(); ++k) lay_rope(k, {});
  read_tensions();
}

}  // namespace sim
