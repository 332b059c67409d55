#include "components/puller_follower/joint_laws.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace control {
namespace {

using Eigen::VectorXd;

class Linearised : public JointLaw {
 public:
  Linearised(const LawParams& params, int n)
      : params_(params), sum_(VectorXd::Zero(n)), acceleration_(sum_), torque_(sum_) {}

  void begin() override { sum_.setZero(); }
  const VectorXd& torque_Nm(const JointErrors& errors, const Dynamics& dynamics,
                            double dt_s) override {
    const double most = params_.integral_rad_s;
    sum_ = (sum_ + dt_s * errors.error_rad).cwiseMax(-most).cwiseMin(most);
    acceleration_ = errors.wanted_rad_per_s2 + params_.kd_per_s * errors.error_rad_per_s +
                    params_.kp_per_s2 * errors.error_rad + params_.ki_per_s3 * sum_;
    torque_ = dynamics.bias;
    torque_.noalias() += dynamics.inertia * acceleration_;
    return torque_;
  }

 private:
  LawParams params_;
  VectorXd sum_, acceleration_, torque_;
};

class LoopShaping : public JointLaw {
 public:
  LoopShaping(const LawParams& params, sim::Musculoskeletal& model)
      : params_(params),
        hinges_(sim::loop_shaping::hinges_of(model)),
        loops_(sim::loop_shaping::joint_loops(model, params.shape).core(), period_s),
        asked_(VectorXd::Zero(model.coordinates())),
        alignment_(model.coordinates(), model.coordinates()),
        torque_(VectorXd::Zero(model.coordinates())) {}

  void begin() override { loops_.reset(); }
  const VectorXd& torque_Nm(const JointErrors& errors, const Dynamics& dynamics,
                            double dt_s) override {
    // Frames that were lost: what is known now was so since.
    const long periods = std::clamp(std::lround(dt_s / period_s), 1L, 5L);
    for (long k = 0; k < periods; ++k) asked_ = loops_.step(errors.error_rad);
    sim::loop_shaping::align(dynamics.inertia, hinges_, params_.shape, alignment_);
    torque_ = params_.gravity * dynamics.gravity;
    torque_.noalias() += alignment_ * asked_;
    torque_.noalias() += params_.feedforward * (dynamics.inertia * errors.wanted_rad_per_s2);
    return torque_;
  }

 private:
  static constexpr double period_s = 0.002;  ///< of sensor frames
  LawParams params_;
  std::vector<sim::loop_shaping::Hinge> hinges_;
  sim::loop_shaping::Sampled loops_;
  VectorXd asked_;
  Eigen::MatrixXd alignment_;
  VectorXd torque_;
};

class Pd : public JointLaw {
 public:
  Pd(const LawParams& params, sim::Musculoskeletal& model) : params_(params) {
    const int n = model.coordinates();
    Eigen::MatrixXd inertia(n, n);
    model.skeleton().inertia(inertia);
    inertia_ = inertia.diagonal(), torque_ = inertia_;
  }
  void begin() override {}
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
        throw std::invalid_argument(std::string("no loops of that shape: ") + error.what() +
                                    "; give a lower crossover_Hz or more lead");
      }
    case Law::pd:
      return std::make_unique<Pd>(params, model);
  }
  throw std::invalid_argument("no such law");
}

}  // namespace control
