#include "sim/gap/residual_vector.hpp"

#include <cmath>

#include "sim/parallel/in_parallel.hpp"
#include "sim/residuals/floor.hpp"

namespace sim::gap {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

/// rms of what other noise changes in a stage; 0: nothing, or nothing to be seen.
double floor_of(const residuals::Residual& real, const residuals::Residual& disturbed) {
  double square = 0, count = 0;
  for (std::size_t k = 0; k < real.value.size(); ++k)
    if (const double change = disturbed.value[k] - real.value[k];
        !std::isnan(change) && !residuals::banded(real, k) && !residuals::banded(disturbed, k))
      square += change * change, ++count;
  return count > 0 ? std::sqrt(square / count) : 0;
}

}  // namespace

ResidualVector::ResidualVector(const erp::Robot& nominal,
                               std::span<const residuals::Episode> episodes, std::uint64_t seed,
                               int threads)
    : episodes_(episodes) {
  for (const residuals::Episode& episode : episodes)
    disturbed_.push_back(residuals::said_again(episode, nominal, seed));
  bare_ = explain(nominal, threads).real;
  for (const residuals::Explanation& e : bare_) {
    stages_ = e.residuals.size();
    for (std::size_t r = 0; r < stages_; ++r) {
      blocks_.push_back({r, size_, Index(e.residuals[r].value.size())});
      size_ += blocks_.back().count;
    }
  }
}

Explained ResidualVector::explain(const erp::Robot& robot, int threads) const {
  const std::size_t count = episodes_.size();
  Explained all{std::vector<residuals::Explanation>(count),
                std::vector<residuals::Explanation>(count)};
  in_parallel(2 * count, threads, [&](std::size_t n) {
    const std::size_t e = n / 2;
    if (n % 2) all.disturbed[e] = residuals::Stages(robot).explain(disturbed_[e]);
    else all.real[e] = residuals::Stages(robot).explain(episodes_[e]);
  });
  return all;
}

Explained ResidualVector::explain(const erp::Robot& robot, const Explained& base,
                                  const residuals::Reach& reach) const {
  residuals::Stages stages(robot);
  Explained all;
  for (std::size_t e = 0; e < episodes_.size(); ++e) {
    all.real.push_back(stages.explain(episodes_[e], base.real[e], reach));
    all.disturbed.push_back(stages.explain(disturbed_[e], base.disturbed[e], reach));
  }
  return all;
}

VectorXd ResidualVector::z(const Explained& explained) const {
  VectorXd z = VectorXd::Zero(size_);
  std::size_t b = 0;
  for (std::size_t e = 0; e < bare_.size(); ++e)
    for (std::size_t r = 0; r < bare_[e].residuals.size(); ++r, ++b) {
      const auto &was = bare_[e].residuals[r], &is = explained.real[e].residuals[r];
      const double floor = floor_of(is, explained.disturbed[e].residuals[r]);
      for (std::size_t k = 0; k < was.value.size() && floor > 0; ++k) {
        if (std::isnan(was.value[k])) continue;
        const auto& taken = std::isnan(is.value[k]) ? was : is;
        z[blocks_[b].first + Index(k)] = taken.value[k] / floor;
      }
    }
  return z;
}

}  // namespace sim::gap
