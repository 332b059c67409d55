#include "sim/gap/estimation/residual_vector.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <ranges>

#include "interfaces/parallel/in_parallel.hpp"
#include "sim/gap/residuals/band.hpp"
#include "sim/gap/residuals/noise_floor.hpp"

namespace sim::estimation {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

/// Changes of a stage by added noise, in the windows that both explanations have.
struct Changes {
  std::vector<double> squares = {};

  double rms() const { return root_of_mean(squares.end()); }
  /// Without the largest 1 %: the change of a window that becomes judged is not noise.
  double trimmed_rms() {
    constexpr double quantile = 0.99;  // chosen
    const auto end = squares.begin() + std::ptrdiff_t(quantile * double(squares.size()));
    if (end != squares.end()) std::ranges::nth_element(squares, end);
    return root_of_mean(end);
  }
  void add(const residuals::Residual& real, const residuals::Residual& disturbed) {
    for (std::size_t k = 0; k < disturbed.value.size(); ++k)
      if (const double change = disturbed.value[k] - real.value[k];
          !std::isnan(change) && !residuals::banded(real, k) && !residuals::banded(disturbed, k))
        squares.push_back(change * change);
  }

 private:
  double root_of_mean(std::vector<double>::const_iterator end) const {
    const auto count = double(end - squares.begin());
    return count > 0 ? std::sqrt(std::accumulate(squares.begin(), end, 0.0) / count) : 0;
  }
};

std::vector<Changes> changes_by_stage(const Explained& explained) {
  std::vector<Changes> all(explained.real.front().residuals.size());
  for (std::size_t e = 0; e < explained.real.size(); ++e)
    for (std::size_t s = 0; s < all.size(); ++s)
      all[s].add(explained.real[e].residuals[s], explained.disturbed[e].residuals[s]);
  return all;
}

/// The first rows of an episode.
void cut(residuals::Episode& e, std::size_t rows) {
  const auto cut = [&](residuals::Signal& s) { s.resize(std::min(s.size(), rows)); };
  for (residuals::ActuatorSignals& s : e.actuators)
    for (residuals::Signal* each : {&s.mode, &s.reference, &s.voltage_V, &s.current_A, &s.shaft_rad,
                                    &s.tension_N, &s.sent, &s.followed})
      cut(*each);
  for (residuals::JointSignals& j : e.joints) {
    cut(j.angle_rad);
    for (residuals::Signal& part : j.quaternion) cut(part);
  }
  e.rows = std::min(e.rows, rows);
}

}  // namespace

ResidualVector::ResidualVector(const erp::Robot& nominal,
                               std::span<const residuals::Episode> episodes, std::uint64_t seed,
                               int threads)
    : episodes_(episodes) {
  for (const residuals::Episode& episode : episodes)
    disturbed_.push_back(residuals::resampled_noise(episode, nominal, seed));
  Explained nominal_explained = explain(nominal, threads);
  nominal_ = nominal_explained.real;
  for (const residuals::Explanation& e : nominal_) {
    stages_ = e.residuals.size();
    for (std::size_t r = 0; r < stages_; ++r) {
      blocks_.push_back({r, size_, Index(e.residuals[r].value.size())});
      size_ += blocks_.back().count;
    }
  }
  floors_ = floors(nominal_explained);
  count_independent(nominal_explained);
  cut_disturbed(nominal, nominal_explained);
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
    independent_[r] += double(noise.size()) / correlation_length(noise);
  }
}

/// Noise floors of whole episodes, one per block.
std::vector<double> ResidualVector::floors(const Explained& explained) const {
  std::vector<double> all;
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    Changes changes;
    changes.add(explained.real[b / stages_].residuals[b % stages_],
                explained.disturbed[b / stages_].residuals[b % stages_]);
    all.push_back(changes.rms());
  }
  return all;
}

/// Replaces the disturbed episodes by their first parts if every stage has enough windows in them.
void ResidualVector::cut_disturbed(const erp::Robot& robot, const Explained& nominal) {
  constexpr double part = 1 / 3.0;            // of the rows; chosen
  constexpr double least_windows = part / 2;  // of the windows; chosen
  const std::vector<Changes> whole_changes = changes_by_stage(nominal);
  std::vector<residuals::Episode> first = disturbed_;
  Explained cut_nominal{nominal.real, {}};
  for (std::size_t e = 0; e < first.size(); ++e) {
    const std::size_t first_row = first[e].judged_from,
                      last_row = std::min(first[e].judged_until, first[e].rows);
    cut(first[e], first_row + std::size_t(part * double(last_row - std::min(first_row, last_row))));
    cut_nominal.disturbed.push_back(residuals::Stages(robot).explain(first[e]));
  }
  std::vector<Changes> first_changes = changes_by_stage(cut_nominal);
  const auto has_enough_windows = [&](std::size_t s) {
    return double(first_changes[s].squares.size()) >=
           least_windows * double(whole_changes[s].squares.size());
  };
  if (std::ranges::all_of(std::views::iota(std::size_t(0), stages_), has_enough_windows))
    disturbed_ = std::move(first);
  else first_changes = whole_changes;
  for (Changes& c : first_changes) first_floors_.push_back(c.trimmed_rms());
}

std::vector<double> ResidualVector::floor_ratio(const Explained& explained) const {
  std::vector<double> all(stages_, 1.0);
  std::vector<Changes> changes = changes_by_stage(explained);
  for (std::size_t s = 0; s < stages_; ++s)
    if (first_floors_[s] > 0) all[s] = changes[s].trimmed_rms() / first_floors_[s];
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

namespace {

/// A residual in units of its noise. A residual within a friction band has no sign. It gets the
/// sign of the nominal robot's residual, because a sign that differs between robots would be a
/// jump.
double with_fixed_sign(const residuals::Residual& nominal, const residuals::Residual& r,
                       std::size_t window, double floor) {
  const double z = residuals::normalized(r, window, floor), reference = nominal.value[window];
  if (!residuals::banded(nominal, window) && !residuals::banded(r, window)) return z;
  return std::copysign(z, reference != 0 ? reference : window % 2 ? -1 : 1);
}

}  // namespace

VectorXd ResidualVector::z(const Explained& explained) const {
  VectorXd z = VectorXd::Zero(size_);
  const auto floor_ratio = this->floor_ratio(explained);
  for (std::size_t b = 0; b < blocks_.size(); ++b) {
    const std::size_t e = b / stages_, r = b % stages_;
    const auto &nominal = nominal_[e].residuals[r], &actual = explained.real[e].residuals[r];
    const double floor = floors_[b] * floor_ratio[r];
    for (std::size_t k = 0; k < nominal.value.size() && floor > 0; ++k) {
      if (std::isnan(nominal.value[k])) continue;
      const auto& available = std::isnan(actual.value[k]) ? nominal : actual;
      z[blocks_[b].first + Index(k)] = with_fixed_sign(nominal, available, k, floor);
    }
  }
  return z;
}

double correlation_length(std::span<const double> series) {
  constexpr std::size_t longest_lag = 50;  // windows: one second
  constexpr double negligible = 0.05;      // correlation; chosen
  double square = 0;
  for (const double x : series) square += x * x;
  double sum = 1;
  for (std::size_t lag = 1; lag < std::min(longest_lag, series.size()) && square > 0; ++lag) {
    double product = 0;
    for (std::size_t k = lag; k < series.size(); ++k) product += series[k] * series[k - lag];
    if (product < negligible * square) break;
    sum += 2 * product / square;
  }
  return sum;
}

VectorXd tiny_change(const VectorXd& after, const VectorXd& before) {
  constexpr double factor = 20, quantile = 0.99;  // a jump is above factor × quantile; chosen
  VectorXd change = after - before;
  std::vector<double> sizes;
  for (const double c : change)
    if (c != 0) sizes.push_back(std::abs(c));
  if (sizes.empty()) return change;
  const auto at = sizes.begin() + std::ptrdiff_t(quantile * double(sizes.size() - 1));
  std::ranges::nth_element(sizes, at);
  const double jump = factor * *at;
  return change.unaryExpr([&](double c) { return std::abs(c) > jump ? 0.0 : c; });
}

}  // namespace sim::estimation
