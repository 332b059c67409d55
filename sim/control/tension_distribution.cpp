#include "sim/control/tension_distribution.hpp"

#include <stdexcept>

#include "interfaces/xml/values.hpp"

namespace sim {
namespace {

using Vector = Eigen::VectorXd;

/// ρ, for moment arms of centimetres and Σ g f² with g = 1; chosen: relative torque error of 1e-5.
constexpr double torque_weight = 1e9;

/// g up to a common factor.
double weight_of(const erp::Robot& robot, const erp::Actuator& actuator,
                 TensionObjective objective) {
  switch (objective) {
    case TensionObjective::least_energy: {
      const erp::MotorType& motor = robot.motor_of(actuator);
      const double A_per_N = actuator.spindle.radius_m /
                             (motor.gear_efficiency * motor.gear_ratio * motor.torque_Nm_per_A);
      return motor.resistance_ohm * A_per_N * A_per_N;
    }
    case TensionObjective::least_activation:
      return 1 / (actuator.max_tension_N * actuator.max_tension_N);
    case TensionObjective::least_tension:
    case TensionObjective::smooth:
      break;
  }
  return 1;
}

}  // namespace

ObjectiveTerms objective_terms(const erp::Robot& robot, TensionObjective objective,
                               double least_N) {
  const auto n = static_cast<Eigen::Index>(robot.actuators.size());
  ObjectiveTerms terms{Vector(n), Vector::Zero(n), Vector::Constant(n, least_N), Vector(n),
                       objective == TensionObjective::smooth};
  for (Eigen::Index a = 0; a < n; ++a) {
    const erp::Actuator& actuator = robot.actuators[static_cast<std::size_t>(a)];
    if (!(least_N >= 0 && least_N < actuator.max_tension_N))
      throw std::invalid_argument("the least tension of " + xml::write_number(least_N) +
                                  " N must be at least 0 and below max_tension_N=" +
                                  xml::write_number(actuator.max_tension_N) + " of actuator \"" +
                                  actuator.name + "\"");
    terms.weight[a] = weight_of(robot, actuator, objective);
    terms.high_N[a] = actuator.max_tension_N;
  }
  if (objective == TensionObjective::least_tension || terms.previous_is_preferred)
    terms.preferred_N = terms.low_N;
  return terms;
}

TensionDistribution::TensionDistribution(const ObjectiveTerms& terms, int coordinates)
    : terms_(terms),
      low_(terms.low_N),
      high_(terms.high_N),
      c_(terms.low_N),
      tension_(terms.low_N),
      residual_(Vector::Zero(coordinates)),
      h_(terms.low_N.size(), terms.low_N.size()),
      qp_(terms.low_N.size()) {
  terms_.weight /= terms_.weight.mean();
}

/// H = G + ρ L Lᵀ,   c = G f° − ρ L τ
const Vector& TensionDistribution::distribute(const Matrix& l, const Vector& torque) {
  h_.noalias() = torque_weight * l * l.transpose();
  h_.diagonal() += terms_.weight;
  c_.noalias() = -torque_weight * l * torque;
  c_ += terms_.weight.cwiseProduct(terms_.preferred_N);
  tension_ = qp_.solve(h_, c_, low_, high_);
  residual_ = torque;
  residual_.noalias() += l.transpose() * tension_;
  if (terms_.previous_is_preferred) terms_.preferred_N = tension_;
  return tension_;
}

void TensionDistribution::fix(int actuator, double tension_N) {
  const bool is_fixed = tension_N >= 0;
  low_[actuator] = is_fixed ? tension_N : terms_.low_N[actuator];
  high_[actuator] = is_fixed ? tension_N : terms_.high_N[actuator];
}

}  // namespace sim
