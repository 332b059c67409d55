#include "sim/control/tension_share.hpp"

#include <stdexcept>

#include "interfaces/xml/values.hpp"

namespace sim {
namespace {

using Vector = Eigen::VectorXd;

/// ρ, for moment arms of centimetres and Σ g f² with g = 1; chosen: torques are met to 1e-5.
constexpr double stiffness = 1e9;

/// g but for a common factor.
double weight_of(const erp::Robot& robot, const erp::Actuator& actuator, Liking liking) {
  switch (liking) {
    case Liking::least_energy: {
      const erp::MotorType& motor = robot.motor_of(actuator);
      const double A_per_N = actuator.spindle.radius_m /
                             (motor.gear_efficiency * motor.gear_ratio * motor.torque_Nm_per_A);
      return motor.resistance_ohm * A_per_N * A_per_N;
    }
    case Liking::least_activation:
      return 1 / (actuator.max_tension_N * actuator.max_tension_N);
    case Liking::least_tension:
    case Liking::smooth:
      break;
  }
  return 1;
}

}  // namespace

Likes likes_of(const erp::Robot& robot, Liking liking, double least_N) {
  const auto n = static_cast<Eigen::Index>(robot.actuators.size());
  Likes likes{Vector(n), Vector::Zero(n), Vector::Constant(n, least_N), Vector(n),
              liking == Liking::smooth};
  for (Eigen::Index a = 0; a < n; ++a) {
    const erp::Actuator& actuator = robot.actuators[static_cast<std::size_t>(a)];
    if (!(least_N >= 0 && least_N < actuator.max_tension_N))
      throw std::invalid_argument("least tension of " + xml::write_number(least_N) +
                                  " N must be at least 0 and below the " +
                                  xml::write_number(actuator.max_tension_N) +
                                  " N that actuator \"" + actuator.name + "\" may pull");
    likes.weight[a] = weight_of(robot, actuator, liking);
    likes.high_N[a] = actuator.max_tension_N;
  }
  if (liking == Liking::least_tension || likes.as_before) likes.liked_N = likes.low_N;
  return likes;
}

TensionShare::TensionShare(const Likes& likes, int coordinates)
    : likes_(likes),
      low_(likes.low_N),
      high_(likes.high_N),
      c_(likes.low_N),
      tension_(likes.low_N),
      missing_(Vector::Zero(coordinates)),
      h_(likes.low_N.size(), likes.low_N.size()),
      qp_(likes.low_N.size()) {
  likes_.weight /= likes_.weight.mean();
}

/// H = G + ρ L Lᵀ,   c = G f° − ρ L τ
const Vector& TensionShare::share(const Matrix& l, const Vector& torque) {
  h_.noalias() = stiffness * l * l.transpose();
  h_.diagonal() += likes_.weight;
  c_.noalias() = -stiffness * l * torque;
  c_ += likes_.weight.cwiseProduct(likes_.liked_N);
  tension_ = qp_.solve(h_, c_, low_, high_);
  missing_ = torque;
  missing_.noalias() += l.transpose() * tension_;
  if (likes_.as_before) likes_.liked_N = tension_;
  return tension_;
}

void TensionShare::fix(int actuator, double tension_N) {
  const bool bound = tension_N >= 0;
  low_[actuator] = bound ? tension_N : likes_.low_N[actuator];
  high_[actuator] = bound ? tension_N : likes_.high_N[actuator];
}

}  // namespace sim
