#include "sim/learning/experience/feedback.hpp"

#include <fl/Headers.h>

#include <fstream>
#include <sstream>
#include <stdexcept>

namespace sim::experience {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

class Linear final : public Feedback {
 public:
  explicit Linear(MatrixXd gain_V_per_m) : gain_V_per_m_(std::move(gain_V_per_m)) {}
  VectorXd drives_V(const Vector3d& off_m, const Vector3d&) const override {
    return gain_V_per_m_ * off_m;
  }

 private:
  MatrixXd gain_V_per_m_;
};

class Fuzzy final : public Feedback {
 public:
  Fuzzy(MatrixXd jacobi, const std::string& file) : jacobi_(std::move(jacobi)) {
    std::ifstream in(file);
    std::ostringstream text;
    if (!(text << in.rdbuf())) throw std::invalid_argument(file + ": cannot be read");
    try {
      engine_.reset(fl::FllImporter().fromString(text.str()));
      off_ = engine_->getInputVariable("off_m");
      rate_ = engine_->getInputVariable("off_m_per_s");
      voltage_ = engine_->getOutputVariable("voltage_V");
    } catch (const fl::Exception& e) {
      throw std::invalid_argument(file + ": " + e.getWhat());
    }
    std::string reason;
    if (!engine_->isReady(&reason)) throw std::invalid_argument(file + ": " + reason);
  }
  VectorXd drives_V(const Vector3d& off_m, const Vector3d& off_m_per_s) const override {
    Vector3d fuzzy_V;
    for (int k = 0; k < 3; ++k) {
      off_->setValue(off_m[k]), rate_->setValue(off_m_per_s[k]);
      engine_->process();
      fuzzy_V[k] = voltage_->getValue();
    }
    return jacobi_ * fuzzy_V;
  }

 private:
  MatrixXd jacobi_;
  std::unique_ptr<fl::Engine> engine_;
  fl::InputVariable *off_ = nullptr, *rate_ = nullptr;
  fl::OutputVariable* voltage_ = nullptr;
};

}  // namespace

std::unique_ptr<Feedback> linear_feedback(const Base& base, int start, const Vector3d& target_m,
                                          double gain_per_s) {
  return std::make_unique<Linear>(
      gain_per_s * weighted_inverse(base.influence(start, target_m), base.freedom(start)));
}

std::unique_ptr<Feedback> fuzzy_feedback(const Base& base, int start, const std::string& fll_file) {
  MatrixXd jacobi = weighted_inverse(base.influence(start), base.freedom(start));
  const double largest = jacobi.cwiseAbs().maxCoeff();
  if (largest > 0) jacobi /= largest;
  return std::make_unique<Fuzzy>(std::move(jacobi), fll_file);
}

}  // namespace sim::experience
