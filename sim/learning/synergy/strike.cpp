#include "sim/learning/synergy/strike.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sim/model/skeleton/joint_path.hpp"

namespace sim::synergy {
namespace {

constexpr double mean_s = 0.05;      // chosen: reduces the tremor of single points
constexpr double rest_mean_s = 0.2;  // chosen

/// Distance of the surfaces of the hand's sphere and the bottle's capsule.
double gap_m(const BottleConfig& bottle, const Vec3& bottle_m, const Vec3& hand_m) {
  const double half_m = std::max(0.0, 0.5 * bottle.height_m - bottle.radius_m);
  Vec3 off_m = hand_m - bottle_m;
  off_m.z() -= std::clamp(off_m.z(), -half_m, half_m);
  return off_m.norm() - bottle.radius_m - bottle.hand_m;
}

double speed_m_per_s(const HandPath& path, std::size_t k) {
  const std::size_t before = k > 0 ? k - 1 : k, after = std::min(k + 1, path.at_m.size() - 1);
  if (after == before) return 0;
  return (path.at_m[after] - path.at_m[before]).norm() /
         (path.sample_s * static_cast<double>(after - before));
}

/// Means over `mean_s` each.
std::vector<Vec3> averaged_path(const HandPath& path, double end_s) {
  const auto samples_per_mean = static_cast<std::size_t>(std::lround(mean_s / path.sample_s));
  std::vector<Vec3> means_m;
  for (std::size_t k = 0;
       k + samples_per_mean <= path.at_m.size() && double(k) * path.sample_s < end_s;
       k += samples_per_mean) {
    const auto begin = path.at_m.begin() + static_cast<std::ptrdiff_t>(k);
    means_m.push_back(std::accumulate(begin, begin + static_cast<std::ptrdiff_t>(samples_per_mean),
                                      Vec3(Vec3::Zero())) /
                      double(samples_per_mean));
  }
  return means_m;
}

/// Σ |third difference|².
double jerks(const std::vector<Vec3>& at_m) {
  double squares = 0;
  for (std::size_t k = 0; k + 3 < at_m.size(); ++k)
    squares += (at_m[k + 3] - 3 * at_m[k + 2] + 3 * at_m[k + 1] - at_m[k]).squaredNorm();
  return squares;
}

}  // namespace

Outcome evaluate(const BottleConfig& bottle, const Vec3& bottle_m, const HandPath& path,
                 double end_s) {
  Outcome outcome;
  int samples_after_end = 0, stayed = 0;
  for (std::size_t k = 0; k < path.at_m.size(); ++k) {
    const double time_s = path.sample_s * static_cast<double>(k);
    const double gap = gap_m(bottle, bottle_m, path.at_m[k]);
    outcome.nearest_m = std::min(outcome.nearest_m, gap);
    if (gap <= 0 && !outcome.struck) {
      outcome.struck = true, outcome.strike_s = time_s;
      outcome.strike_speed_m_per_s = speed_m_per_s(path, k);
    }
    if (time_s < end_s) continue;
    ++samples_after_end;
    if ((path.at_m[k] - bottle_m).norm() <= bottle.zone_m) ++stayed;
  }
  outcome.stayed = samples_after_end > 0 ? static_cast<double>(stayed) / samples_after_end : 0;
  outcome.reward = (outcome.struck ? 1 : 0) + bottle.zone_reward * outcome.stayed;
  return outcome;
}

Vec3 rest_of(const HandPath& path) {
  const auto last_samples = static_cast<std::size_t>(std::lround(rest_mean_s / path.sample_s));
  const std::size_t count = std::min(path.at_m.size(), std::max<std::size_t>(1, last_samples));
  Vec3 sum = Vec3::Zero();
  for (std::size_t k = path.at_m.size() - count; k < path.at_m.size(); ++k) sum += path.at_m[k];
  return count > 0 ? Vec3(sum / static_cast<double>(count)) : sum;
}

double relative_jerk(const HandPath& path, double end_s) {
  std::vector<Vec3> at_m = averaged_path(path, end_s), reference_m;
  if (at_m.size() < 4) return 0;
  const Vec3 displacement_m = at_m.back() - at_m.front();
  for (std::size_t k = 0; k < at_m.size(); ++k)
    reference_m.push_back(displacement_m *
                          minimum_jerk(double(k) / double(at_m.size() - 1)).fraction);
  return jerks(at_m) / std::max(jerks(reference_m), 1e-12);
}

}  // namespace sim::synergy
