#include "sim/learning/calibration/sensitivity.hpp"

#include <Eigen/Cholesky>
#include <Eigen/SVD>
#include <stdexcept>

namespace sim::calibration {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Each pose's numbers one after the other.
VectorXd stacked(const std::vector<VectorXd>& parts) {
  const Index each = parts.front().size();
  VectorXd all(each * std::ssize(parts));
  for (std::size_t k = 0; k < parts.size(); ++k)
    all.segment(each * static_cast<Index>(k), each) = parts[k];
  return all;
}

VectorXd turn_between(const erp::Robot& robot, const Pose& from, const Pose& to) {
  std::vector<double> turn;
  const auto joints = robot.joints();
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const auto way = way_between(joints[j].type, from[j], to[j]);
    turn.insert(turn.end(), way.begin(), way.begin() + coordinates_of(joints[j].type));
  }
  return Eigen::Map<VectorXd>(turn.data(), std::ssize(turn));
}

struct Rests {
  std::vector<Pose> pose;
  VectorXd turn_rad;
  std::vector<MatrixXd> compliance;
};

Rests rests_of(const Candidate& candidate, std::span<const StillPose> poses, bool compliance) {
  Equilibrium equilibrium(candidate.robot, candidate.longer_m);
  Rests rests;
  std::vector<VectorXd> turn;
  for (const StillPose& still : poses) {
    const Pose rest = equilibrium.find(still.shaft_rad, still.pose).pose;
    turn.push_back(turn_between(candidate.robot, still.pose, rest));
    rests.pose.push_back(rest);
    if (compliance)
      rests.compliance.push_back(equilibrium.compliance_rad_per_Nm(still.shaft_rad, rest));
  }
  rests.turn_rad = stacked(turn);
  return rests;
}

/// How all poses give way to what a candidate's torques are there.
VectorXd gives_way(const Candidate& candidate, std::span<const StillPose> poses,
                   const Rests& rests) {
  Equilibrium equilibrium(candidate.robot, candidate.longer_m);
  std::vector<VectorXd> turn;
  for (std::size_t k = 0; k < poses.size(); ++k)
    turn.push_back(rests.compliance[k] * -equilibrium.torque_Nm(poses[k].shaft_rad, rests.pose[k]));
  return stacked(turn);
}

/// ∂f/∂x of some f(candidate), a column a parameter; backwards where forwards there is no
/// candidate. Throws std::invalid_argument: neither way.
template <class Of>
MatrixXd slope_of(const Parameters& parameters, const VectorXd& x, const Pool& pool, Of of) {
  constexpr double step = 1e-4;  // of a parameter's spread
  const VectorXd here = of(parameters.at(x));
  const auto quotient = [&](std::size_t k, double along) {
    VectorXd beside = x;
    beside[static_cast<Index>(k)] += along;
    const VectorXd slope = (of(parameters.at(beside)) - here) / along;
    return Pool::Numbers(slope.begin(), slope.end());
  };
  const auto columns = pool.map(static_cast<std::size_t>(x.size()), [&](std::size_t k) {
    try {
      return quotient(k, step);
    } catch (const std::invalid_argument&) {
      return quotient(k, -step);
    }
  });
  MatrixXd slope(here.size(), x.size());
  for (std::size_t k = 0; k < columns.size(); ++k)
    slope.col(static_cast<Index>(k)) =
        Eigen::Map<const VectorXd>(columns[k].data(), std::ssize(columns[k]));
  return slope;
}

}  // namespace

VectorXd turns_rad(const Candidate& candidate, std::span<const StillPose> poses) {
  return rests_of(candidate, poses, false).turn_rad;
}

Residuals turns(const Parameters& parameters, const VectorXd& x, std::span<const StillPose> poses,
                const Pool& pool) {
  const Rests rests = rests_of(parameters.at(x), poses, true);
  return {rests.turn_rad, slope_of(parameters, x, pool, [&](const Candidate& candidate) {
            return gives_way(candidate, poses, rests);
          })};
}

VectorXd torques_Nm(const Candidate& candidate, std::span<const StillPose> poses) {
  Equilibrium equilibrium(candidate.robot, candidate.longer_m);
  std::vector<VectorXd> torque;
  for (const StillPose& still : poses)
    torque.push_back(equilibrium.torque_Nm(still.shaft_rad, still.pose));
  return stacked(torque);
}

Residuals torques(const Parameters& parameters, const VectorXd& x, std::span<const StillPose> poses,
                  const Pool& pool) {
  const auto of = [&](const Candidate& candidate) { return torques_Nm(candidate, poses); };
  return {of(parameters.at(x)), slope_of(parameters, x, pool, of)};
}

Identified identified(const MatrixXd& slope, double sigma_rad) {
  const MatrixXd scaled = slope / sigma_rad;
  MatrixXd information = scaled.transpose() * scaled;
  information.diagonal().array() += 1;
  const MatrixXd left =
      information.llt().solve(MatrixXd::Identity(information.rows(), information.cols()));
  const Eigen::JacobiSVD<MatrixXd> singular(scaled);
  return {left.diagonal().cwiseSqrt(),
          static_cast<int>((singular.singularValues().array() > 1).count())};
}

}  // namespace sim::calibration
