#include "sim/gap/residuals/pose_from_tendons.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "sim/gap/residuals/bump.hpp"

namespace sim::residuals {
namespace {

constexpr double smooth_s = 0.006;  // half width of the pose's window; chosen
constexpr double edge_s = 0.03;     // the pose is also removed this near a row without one; chosen
constexpr double slack_N = 0.3;     // below this tension a tendon may be slack; chosen
constexpr double perturbation_rad = 1e-4;  // of the slopes
constexpr double largest_step_rad = 1;     // chosen
constexpr double least_N_per_rad = 5;      // smallest slope that determines a pose; chosen

void smooth(Signal& signal, double period_s) {
  const Bump bump(smooth_s, period_s);
  const Signal rough = signal;
  for (std::size_t k = bump.reach(); k + bump.reach() < rough.size(); ++k)
    signal[k] = bump.mean(rough, k);
}

void fill_forward(Signal& signal) {
  for (std::size_t k = 1; k < signal.size(); ++k)
    if (std::isnan(signal[k])) signal[k] = signal[k - 1];
  for (std::size_t k = signal.size(); k-- > 1;)
    if (std::isnan(signal[k - 1])) signal[k - 1] = signal[k];
}

/// The Gauss-Newton step of the unknowns at one row. `slope`: ∂F̂/∂q, N/rad, tendons × unknowns.
/// Empty: the tendons do not determine the pose there.
Eigen::VectorXd step_at(std::size_t row, const std::vector<ChainTrace>& chains,
                        const Eigen::Ref<const Eigen::MatrixXd>& slope) {
  Eigen::VectorXd difference_N(slope.rows());
  for (Eigen::Index a = 0; a < difference_N.size(); ++a) {
    const ChainTrace& line = chains[std::size_t(a)];
    difference_N[a] = line.tension_N[row] - line.spring_N[row];
    if (!std::isfinite(difference_N[a])) difference_N[a] = 0;
  }
  const Eigen::MatrixXd normal = slope.transpose() * slope;
  const Eigen::VectorXd gradient = slope.transpose() * difference_N;
  Eigen::VectorXd step(gradient.size());
  if (step.size() == 1) {
    if (normal(0, 0) < least_N_per_rad * least_N_per_rad) return {};
    step = gradient / normal(0, 0);
  } else {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> modes(normal);
    if (modes.eigenvalues()[0] < least_N_per_rad * least_N_per_rad) return {};
    step = modes.eigenvectors() *
           (modes.eigenvectors().transpose() * gradient).cwiseQuotient(modes.eigenvalues());
  }
  return step.cwiseMax(-largest_step_rad).cwiseMin(largest_step_rad);
}

}  // namespace

PoseSearch::PoseSearch(const std::vector<erp::Joint>& joints, std::vector<std::size_t> missing,
                       Chains chains, double period_s, double damper_s)
    : joints_(joints),
      missing_(std::move(missing)),
      chains_(std::move(chains)),
      period_s_(period_s),
      damper_s_(damper_s) {
  for (const std::size_t j : missing_)
    for (int axis = 0; axis < coordinates_of(joints_[j].type); ++axis)
      unknown_.push_back({j, axis});
}

void PoseSearch::turn(std::vector<JointSignals>& signals, const Unknown& unknown, std::size_t row,
                      double rad) const {
  JointSignals& joint = signals[unknown.joint];
  if (joints_[unknown.joint].type == erp::JointType::revolute) {
    joint.angle_rad[row] += rad;
    return;
  }
  auto& q = joint.quaternion;
  const Eigen::Quaterniond before(q[0][row], q[1][row], q[2][row], q[3][row]);
  const Eigen::Quaterniond after =
      before.normalized() *
      Eigen::Quaterniond(Eigen::AngleAxisd(rad, Eigen::Vector3d::Unit(unknown.axis)));
  q[0][row] = after.w(), q[1][row] = after.x(), q[2][row] = after.y(), q[3][row] = after.z();
}

template <class Change>
void PoseSearch::change_missing(std::vector<JointSignals>& signals, Change each) const {
  for (const std::size_t j : missing_) {
    each(signals[j].angle_rad);
    for (Signal& part : signals[j].quaternion) each(part);
  }
}

void PoseSearch::start(std::vector<JointSignals>& signals, std::size_t rows) const {
  for (const std::size_t j : missing_) {
    const JointReading start = initial_reading(joints_[j]);
    if (joints_[j].type == erp::JointType::revolute)
      signals[j].angle_rad.assign(rows, start.position[0]);
    if (joints_[j].type == erp::JointType::spherical)
      for (std::size_t k = 0; k < 4; ++k) signals[j].quaternion[k].assign(rows, start.position[k]);
  }
}

Eigen::MatrixXd PoseSearch::slopes(const std::vector<JointSignals>& signals,
                                   const std::vector<ChainTrace>& chains) const {
  const std::size_t rows = chains.at(0).spring_N.size(), lines = chains.size();
  Eigen::MatrixXd slopes =
      Eigen::MatrixXd::Zero(Eigen::Index(lines * unknown_.size()), Eigen::Index(rows));
  for (std::size_t c = 0; c < unknown_.size(); ++c) {
    auto perturbed = signals;
    for (std::size_t k = 0; k < rows; ++k) turn(perturbed, unknown_[c], k, perturbation_rad);
    const auto moved = chains_(perturbed);
    for (std::size_t k = 0; k < rows; ++k)
      for (std::size_t a = 0; a < lines; ++a) {
        const double slope = (moved[a].spring_N[k] - chains[a].spring_N[k]) / perturbation_rad;
        if (std::isfinite(slope) && chains[a].tension_N[k] > slack_N)
          slopes(Eigen::Index(c * lines + a), Eigen::Index(k)) = slope;
      }
  }
  return slopes;
}

void PoseSearch::refine(std::vector<JointSignals>& signals, int steps, int slopes_every) const {
  change_missing(signals, fill_forward);
  std::vector<char> determined;
  Eigen::MatrixXd slope;
  for (int n = 0; n < steps; ++n) {
    const auto chains = chains_(signals);
    if (n % slopes_every == 0) slope = slopes(signals, chains);
    determined.assign(std::size_t(slope.cols()), 0);
    Eigen::VectorXd step = Eigen::VectorXd::Zero(Eigen::Index(unknown_.size()));
    const double damper_weight = damper_s_ / (damper_s_ + period_s_);
    for (std::size_t k = 0; k < determined.size(); ++k) {
      const Eigen::Map<const Eigen::MatrixXd> at(slope.col(Eigen::Index(k)).data(),
                                                 Eigen::Index(chains.size()),
                                                 Eigen::Index(unknown_.size()));
      const Eigen::VectorXd spring_step = step_at(k, chains, at);
      determined[k] = spring_step.size() > 0;
      if (determined[k]) step = damper_weight * step + (1 - damper_weight) * spring_step;
      else step.setZero();
      for (Eigen::Index c = 0; c < step.size(); ++c)
        turn(signals, unknown_[std::size_t(c)], k, step[c]);
    }
    change_missing(signals, [&](Signal& signal) { smooth(signal, period_s_); });
  }
  const auto edge_rows = static_cast<std::size_t>(edge_s / period_s_);
  change_missing(signals, [&](Signal& signal) {
    for (std::size_t k = 0; k < signal.size(); ++k)
      if (!determined[k])
        for (std::size_t n = k < edge_rows ? 0 : k - edge_rows;
             n < std::min(signal.size(), k + edge_rows + 1); ++n)
          signal[n] = recording::not_taken;
  });
}

}  // namespace sim::residuals
