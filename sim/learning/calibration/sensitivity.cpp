#include "sim/learning/calibration/sensitivity.hpp"

#include <Eigen/Cholesky>
#include <Eigen/SVD>
#include <stdexcept>

namespace sim::calibration {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The vectors of all poses, one after the other.
VectorXd stacked(const std::vector<VectorXd>& vectors) {
  const Index size = vectors.front().size();
  VectorXd all(size * std::ssize(vectors));
  for (std::size_t k = 0; k < vectors.size(); ++k)
    all.segment(size * static_cast<Index>(k), size) = vectors[k];
  return all;
}

VectorXd turn_between(const erp::Robot& robot, const Pose& from, const Pose& to) {
  std::vector<double> turns;
  const auto joints = robot.joints();
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const auto u = displacement(joints[j].type, from[j], to[j]);
    turns.insert(turns.end(), u.begin(), u.begin() + coordinates_of(joints[j].type));
  }
  return Eigen::Map<VectorXd>(turns.data(), std::ssize(turns));
}

struct Rests {
  std::vector<Pose> pose;
  VectorXd turn_rad;
  std::vector<MatrixXd> compliance;
};

Rests rests_of(const Candidate& candidate, std::span<const StillPose> poses, bool compliance) {
  Equilibrium equilibrium(candidate.robot, candidate.length_offset_m);
  Rests rests;
  std::vector<VectorXd> turns;
  for (const StillPose& still : poses) {
    const Pose rest = equilibrium.find(still.shaft_rad, still.pose).pose;
    turns.push_back(turn_between(candidate.robot, still.pose, rest));
    rests.pose.push_back(rest);
    if (compliance)
      rests.compliance.push_back(equilibrium.compliance_rad_per_Nm(still.shaft_rad, rest));
  }
  rests.turn_rad = stacked(turns);
  return rests;
}

/// First-order change of all equilibria caused by a candidate's torques there.
VectorXd pose_change(const Candidate& candidate, std::span<const StillPose> poses,
                     const Rests& rests) {
  Equilibrium equilibrium(candidate.robot, candidate.length_offset_m);
  std::vector<VectorXd> turns;
  for (std::size_t k = 0; k < poses.size(); ++k)
    turns.push_back(rests.compliance[k] *
                    -equilibrium.torque_Nm(poses[k].shaft_rad, rests.pose[k]));
  return stacked(turns);
}

/// ∂f/∂x of a function f(candidate), one column per parameter. Uses the backward difference if the
/// forward candidate is invalid. Throws std::invalid_argument if both are.
template <class Function>
MatrixXd slope_of(const Parameters& parameters, const VectorXd& x, const Pool& pool,
                  Function function) {
  constexpr double step = 1e-4;  // of a parameter's spread
  const VectorXd value = function(parameters.at(x));
  const auto quotient = [&](std::size_t k, double step_x) {
    VectorXd varied = x;
    varied[static_cast<Index>(k)] += step_x;
    const VectorXd slope = (function(parameters.at(varied)) - value) / step_x;
    return Pool::Numbers(slope.begin(), slope.end());
  };
  const auto columns = pool.map(static_cast<std::size_t>(x.size()), [&](std::size_t k) {
    try {
      return quotient(k, step);
    } catch (const std::invalid_argument&) {
      return quotient(k, -step);
    }
  });
  MatrixXd slope(value.size(), x.size());
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
            return pose_change(candidate, poses, rests);
          })};
}

VectorXd torques_Nm(const Candidate& candidate, std::span<const StillPose> poses) {
  Equilibrium equilibrium(candidate.robot, candidate.length_offset_m);
  std::vector<VectorXd> torque;
  for (const StillPose& still : poses)
    torque.push_back(equilibrium.torque_Nm(still.shaft_rad, still.pose));
  return stacked(torque);
}

Residuals torques(const Parameters& parameters, const VectorXd& x, std::span<const StillPose> poses,
                  const Pool& pool) {
  const auto function = [&](const Candidate& candidate) { return torques_Nm(candidate, poses); };
  return {function(parameters.at(x)), slope_of(parameters, x, pool, function)};
}

Identified identified(const MatrixXd& slope, double sigma_rad) {
  const MatrixXd scaled = slope / sigma_rad;
  MatrixXd information = scaled.transpose() * scaled;
  information.diagonal().array() += 1;
  const MatrixXd remaining =
      information.llt().solve(MatrixXd::Identity(information.rows(), information.cols()));
  const Eigen::JacobiSVD<MatrixXd> singular(scaled);
  return {remaining.diagonal().cwiseSqrt(),
          static_cast<int>((singular.singularValues().array() > 1).count())};
}

}  // namespace sim::calibration
