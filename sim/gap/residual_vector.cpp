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
  Explained bare = explain(nominal, threads);
  bare_ = bare.real;
  for (const residuals::Explanation& e : bare_) {
    stages_ = e.residuals.size();
    for (std::size_t r = 0; r < stages_; ++r) {
      blocks_.push_back({r, size_, Index(e.residuals[r].value.size())});
      size_ += blocks_.back().count;
    }
  }
  floors_ = floors(bare);
  count_independent(bare);
}

void ResidualVector::count_independent(const Explained& nominal) {
  independent_.assign(stages_, 0);
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const std::size_t e = b / stages_, r = b % stages_;
    const auto &real = nominal.real[e].residuals[r].value,
               &disturbed = nominal.disturbed[e].residuals[r].value;
    std::vector<double> noise;
    for (std::size_t k = 0; k < real.size(); ++k)
      if (const double change = disturbed[k] - real[k]; !std::isnan(change))
        noise.push_back(change);
    independent_[r] += double(noise.size()) / correlated(noise);
  }
}

std::vector<double> ResidualVector::floors(const Explained& explained) const {
  std::vector<double> all;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const std::size_t e = b / stages_, r = b % stages_;
    all.push_back(floor_of(explained.real[e].residuals[r], explained.disturbed[e].residuals[r]));
  }
  return all;
}

std::vector<double> ResidualVector::raised(const Explained& explained) const {
  const auto is = floors(explained);
  std::vector<double> now(stages_), nominal(stages_), all(stages_, 1.0);
  for (std::size_t b = 0; b < blocks_.size(); ++b)
    now[blocks_[b].stage] += is[b] * is[b], nominal[blocks_[b].stage] += floors_[b] * floors_[b];
  for (std::size_t s = 0; s < stages_; ++s)
    if (nominal[s] > 0) all[s] = std::sqrt(now[s] / nominal[s]);
  return all;
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
  const auto floors = this->floors(explained);
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const std::size_t e = b / stages_, r = b % stages_;
    const auto &was = bare_[e].residuals[r], &is = explained.real[e].residuals[r];
    for (std::size_t k = 0; k < was.value.size() && floors[b] > 0; ++k) {
      if (std::isnan(was.value[k])) continue;
      const auto& taken = std::isnan(is.value[k]) ? was : is;
      z[blocks_[b].first + Index(k)] = taken.value[k] / floors[b];
    }
  }
  return z;
}

double correlated(std::span<const double> series) {
  constexpr std::size_t furthest = 50;  // windows: a second
  constexpr double small = 0.05;        // a correlation; chosen
  double square = 0;
  for (const double x : series) square += x * x;
  double sum = 1;
  for (std::size_t lag = 1; lag < std::min(furthest, series.size()) && square > 0; ++lag) {
    double product = 0;
    for (std::size_t k = lag; k < series.size(); ++k) product += series[k] * series[k - lag];
    if (product < small * square) break;
    sum += 2 * product / square;
  }
  return sum;
}

}  // namespace sim::gap
