#include "sim/learning/calibration/newton_calibration.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

#include "sim/learning/calibration/saved_point.hpp"
#include "sim/learning/calibration/sensitivity.hpp"
#include "sim/learning/training_loop/random_stream.hpp"

namespace sim::calibration {
namespace {

constexpr int max_attempts = 12;       // chosen
constexpr double min_decrease = 1e-3;  // chosen: relative decrease of the cost by a round

/// `list` holds the current point, then the best candidate so far.
struct NewtonState {
  static constexpr auto element = "newton";
  xml::Place place;
  int rounds = 0, evaluated = 0, restarts = 0;
  double damping = 0, cost = 0;
  bool by_torques = true, done = false;
  std::string seed;
  std::vector<SavedPoint> list;
  void visit(auto& v) {
    v.former("judged", "evaluated"), v.former("kicks", "restarts");
    v.required("rounds", rounds);
    v.required("evaluated", evaluated);
    v.required("restarts", restarts);
    v.required("seed", seed);
    v.required("damping", damping);
    v.required("cost", cost);
    v.required("by_torques", by_torques);
    v.required("done", done);
    v.list(list);
  }
};

}  // namespace

NewtonCalibration::NewtonCalibration(Task task, const NewtonOptions& options)
    : Calibration(std::move(task)), options_(options), x_(best()), cost_(cost(x_)) {}

double NewtonCalibration::cost(const Eigen::VectorXd& x) const {
  try {
    const auto residuals_of = by_torques_ ? torques_Nm : turns_rad;
    const auto residual = residuals_of(task().parameters.at(x), task().poses.learn);
    return (residual / sigma()).squaredNorm() + x.squaredNorm();
  } catch (const std::invalid_argument&) {
    return std::numeric_limits<double>::infinity();
  }
}

void NewtonCalibration::round(const Pool& pool) {
  ++rounds_;
  const double before = cost_;
  if (std::isfinite(cost_)) step(pool);
  continue_from(before);
}

void NewtonCalibration::step(const Pool& pool) {
  const auto residuals_of = by_torques_ ? torques : turns;
  const Residuals at = residuals_of(task().parameters, x_, task().poses.learn, pool);
  const Eigen::MatrixXd slope = at.slope / sigma();
  const Eigen::VectorXd descent = -(slope.transpose() * at.value / sigma() + x_);
  const Eigen::MatrixXd curvature = slope.transpose() * slope;
  const double before = cost_;
  ++evaluated_;
  for (int attempt = 0; attempt < max_attempts && cost_ == before; ++attempt) {
    Eigen::MatrixXd damped = curvature;
    damped.diagonal().array() += 1 + damping_;
    const Eigen::VectorXd candidate = x_ + damped.llt().solve(descent);
    const double next_cost = cost(candidate);
    ++evaluated_;
    if (next_cost < cost_) x_ = candidate, cost_ = next_cost, damping_ /= 10;
    else damping_ *= 10;
  }
  update_best(x_, error_rad(task(), x_)), ++evaluated_;
}

/// If the step has not reduced the cost enough: switches from torques to angles, later restarts
/// from random points until done.
void NewtonCalibration::continue_from(double before) {
  if (before - cost_ >= min_decrease * before) return;  // false if the cost is infinite
  if (by_torques_) return switch_to_angles(x_);
  done_ = restarts_ == options_.restarts || best_error_rad() < options_.sigma_rad;
  if (done_) return;
  auto random =
      training_loop::random_stream(options_.seed, static_cast<std::uint64_t>(++restarts_));
  std::normal_distribution<double> normal(0, options_.kick);
  Eigen::VectorXd x = best();
  for (double& value : x) value += normal(random);
  switch_to_angles(x);
}

void NewtonCalibration::switch_to_angles(const Eigen::VectorXd& x) {
  x_ = x, by_torques_ = false, damping_ = 1;
  cost_ = cost(x_), ++evaluated_;
}

long NewtonCalibration::evaluated_poses() const {
  return evaluated_ * std::ssize(task().poses.learn);
}

std::string NewtonCalibration::state() const {
  NewtonState state{.rounds = rounds_,
                    .evaluated = static_cast<int>(evaluated_),
                    .restarts = restarts_,
                    .damping = damping_,
                    .cost = cost_,
                    .by_torques = by_torques_,
                    .done = done_,
                    .seed = std::to_string(options_.seed)};
  state.list.push_back({{}, numbers(x_), {}, 0});
  state.list.push_back({{}, numbers(best()), {}, best_error_rad()});
  return xml::write(state);
}

void NewtonCalibration::restore(const std::string& text, const std::string& file) {
  const auto state = xml::parse<NewtonState>(text, file);
  expect_same_search(state.list.size() == 2 && state.seed == std::to_string(options_.seed) &&
                         std::ssize(state.list[0].x) == task().parameters.size() &&
                         state.list[0].x.size() == state.list[1].x.size(),
                     file);
  rounds_ = state.rounds, evaluated_ = state.evaluated, restarts_ = state.restarts,
  damping_ = state.damping;
  cost_ = state.cost, by_torques_ = state.by_torques, done_ = state.done,
  x_ = vector(state.list[0].x);
  update_best(vector(state.list[1].x), state.list[1].error_rad);
}

}  // namespace sim::calibration
