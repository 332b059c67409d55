#include "components/puller_follower/joint_laws.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace control {
namespace {

using Eigen::VectorXd;

class Linearised : public JointLaw {
 public:
  Linearised(const LawParams& params, int n)
      : params_(params),
        factor_(n),
        integral_(VectorXd::Zero(n)),
        acceleration_(integral_),
        torque_(integral_) {}

  void begin(const VectorXd& torque_Nm, const Dynamics& dynamics) override {
    integral_.setZero();
    if (params_.ki_per_s3 <= 0) return;
    torque_ = torque_Nm - dynamics.bias;
    factor_.compute(dynamics.inertia);
    factor_.solveInPlace(torque_);
    integral_ = torque_ / params_.ki_per_s3;
    limit_integral();
  }
  const VectorXd& torque_Nm(const JointErrors& errors, const Dynamics& dynamics,
                            double dt_s) override {
    integral_ += dt_s * errors.error_rad;
    limit_integral();
    acceleration_ = errors.desired_rad_per_s2 + params_.kd_per_s * errors.error_rad_per_s +
                    params_.kp_per_s2 * errors.error_rad + params_.ki_per_s3 * integral_;
    torque_ = dynamics.bias;
    torque_.noalias() += dynamics.inertia * acceleration_;
    return torque_;
  }

 private:
  void limit_integral() {
    const double limit = params_.integral_rad_s;
    integral_ = integral_.cwiseMax(-limit).cwiseMin(limit);
  }

  LawParams params_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
  VectorXd integral_, acceleration_, torque_;
};

class LoopShaping : public JointLaw {
 public:
  LoopShaping(const LawParams& params, sim::Musculoskeletal& model)
      : LoopShaping(params, model, sim::loop_shaping::joint_loops(model, params.shape)) {}

  void begin(const VectorXd& torque_Nm, const Dynamics& dynamics) override {
    sim::loop_shaping::align(dynamics.inertia, hinges_, params_.shape, alignment_);
    output_ = torque_Nm - params_.gravity * dynamics.gravity;
    factor_.compute(alignment_);
    factor_.solveInPlace(output_);
    initial_state_.noalias() = holding_ * output_;
    loops_.begin(initial_state_);
  }
  const VectorXd& torque_Nm(const JointErrors& errors, const Dynamics& dynamics,
                            double dt_s) override {
    // After lost frames the current error is applied to each missed period.
    const long periods = std::clamp(std::lround(dt_s / period_s), 1L, max_periods);
    for (long k = 0; k < periods; ++k) output_ = loops_.step(errors.error_rad);
    sim::loop_shaping::align(dynamics.inertia, hinges_, params_.shape, alignment_);
    torque_ = params_.gravity * dynamics.gravity;
    torque_.noalias() += alignment_ * output_;
    torque_.noalias() += params_.feedforward * (dynamics.inertia * errors.desired_rad_per_s2);
    return torque_;
  }

 private:
  LoopShaping(const LawParams& params, sim::Musculoskeletal& model,
              const sim::loop_shaping::JointLoops& loops)
      : params_(params),
        hinges_(sim::loop_shaping::hinges_of(model)),
        loops_(loops.core(), period_s),
        holding_(loops.holding()),
        alignment_(model.coordinates(), model.coordinates()),
        factor_(model.coordinates()),
        output_(VectorXd::Zero(model.coordinates())),
        initial_state_(VectorXd::Zero(holding_.rows())),
        torque_(output_) {}

  static constexpr double period_s = 0.002;  ///< of sensor frames
  static constexpr long max_periods = 5;     ///< chosen: of lost frames
  LawParams params_;
  std::vector<sim::loop_shaping::Hinge> hinges_;
  sim::loop_shaping::Sampled loops_;
  Eigen::MatrixXd holding_, alignment_;
  Eigen::LLT<Eigen::MatrixXd> factor_;
  VectorXd output_, initial_state_, torque_;
};

class Pd : public JointLaw {
 public:
  Pd(const LawParams& params, sim::Musculoskeletal& model) : params_(params) {
    const int n = model.coordinates();
    Eigen::MatrixXd inertia(n, n);
    model.skeleton().inertia(inertia);
    inertia_ = inertia.diagonal(), torque_ = inertia_;
  }
  void begin(const VectorXd&, const Dynamics&) override {}
  const VectorXd& torque_Nm(const JointErrors& errors, const Dynamics& dynamics, double) override {
    torque_ = params_.gravity * dynamics.gravity +
              inertia_.cwiseProduct(params_.kp_per_s2 * errors.error_rad +
                                    params_.kd_per_s * errors.error_rad_per_s);
    return torque_;
  }

 private:
  LawParams params_;
  VectorXd inertia_, torque_;
};

}  // namespace

std::unique_ptr<JointLaw> law_of(Law law, const LawParams& params, sim::Musculoskeletal& model) {
  switch (law) {
    case Law::linearised:
      return std::make_unique<Linearised>(params, model.coordinates());
    case Law::loop_shaping:
      try {
        return std::make_unique<LoopShaping>(params, model);
      } catch (const std::domain_error& error) {
        throw std::invalid_argument(std::string("the loops cannot be shaped: ") + error.what() +
                                    "; give a lower crossover_Hz or more lead");
      }
    case Law::pd:
      return std::make_unique<Pd>(params, model);
  }
  throw std::invalid_argument("no such law");
}

}  // namespace control
