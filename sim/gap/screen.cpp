#include "sim/gap/screen.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>

#include "sim/parallel/in_parallel.hpp"
#include "sim/residuals/drives.hpp"

namespace sim::gap {

using effects::Placed;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

/// Of all turns of a shaft, the share that goes the rarer way.
double rarer_way(std::span<const residuals::Episode> recordings, std::size_t actuator) {
  double forwards = 0, backwards = 0;
  for (const residuals::Episode& e : recordings) {
    const residuals::Signal& theta = e.actuators[actuator].shaft_rad;
    const auto taken = [&](std::size_t row) { return e.judged(row) && !std::isnan(theta[row]); };
    constexpr std::size_t rows = 10;  // apart: noise turns to and fro
    for (std::size_t k = rows; k < theta.size(); k += rows)
      if (taken(k) && taken(k - rows)) {
        const double turned = theta[k] - theta[k - rows];
        (turned > 0 ? forwards : backwards) += std::abs(turned);
      }
  }
  return std::min(forwards, backwards) / std::max(forwards + backwards, 1e-12);
}

/// An effect of a sensor that a drive has not: of a current that its control sets, of a pull without
/// a torque sensor.
bool is_of_no_sensor(const Placed& placed, const erp::Robot& robot, std::size_t actuator,
                     std::span<const residuals::Episode> recordings) {
  const auto sense = effects::sense_of(placed.effect);
  const erp::Drive* drive = sense ? residuals::drive_of(robot, placed.on) : nullptr;
  if (!drive) return false;
  if (sense == effects::Sense::tension) return !drive->find<erp::TorqueSensor>();
  return sense == effects::Sense::current &&
         std::ranges::any_of(recordings, [&](const residuals::Episode& e) {
           return e.actuators[actuator].current_around;
         });
}

/// A parameter that shapes a law: without it the law's size means nothing.
bool shapes(const effects::Parameter& p) { return p.bounds.low > 0; }

/// Values to scan of a parameter that shapes a law.
std::vector<double> grid(const effects::Parameter& p) {
  std::vector<double> values;
  if (std::string_view(p.name) == "periods_per_turn") {
    for (int n = 1; n <= 24; ++n) values.push_back(n);
    return values;
  }
  constexpr int points = 7;
  for (int n = 0; n < points; ++n)
    values.push_back(p.bounds.low * std::pow(p.bounds.high / p.bounds.low, (n + 0.5) / points));
  return values;
}

/// The effect with each value of the parameter that shapes it.
std::vector<Placed> shaped(const Placed& neutral) {
  std::vector<Placed> all{neutral};
  effects::AnyEffect probe = neutral.effect;
  const auto parameters = effects::parameters(probe);
  for (std::size_t p = 0; p < parameters.size(); ++p) {
    if (!shapes(parameters[p])) continue;
    for (const double value : grid(parameters[p])) {
      all.push_back(neutral);
      *effects::parameters(all.back().effect)[p].value = value;
    }
    break;
  }
  return all;
}

}  // namespace

bool can_show(const Placed& placed, const erp::Robot& robot,
              std::span<const residuals::Episode> recordings) {
  constexpr double enough = 0.02;  // of all turns; chosen
  const std::size_t a =
      std::size_t(std::ranges::find(robot.actuators, placed.on, &erp::Actuator::name) -
                  robot.actuators.begin());
  if (is_of_no_sensor(placed, robot, a, recordings)) return false;
  return !std::holds_alternative<effects::GearboxAsymmetric>(placed.effect) ||
         rarer_way(recordings, a) > enough;
}

/// One shape of an effect, its sizes as they are nudged, and what each nudge changes in z.
struct Directions {
  Placed shape;
  std::vector<std::size_t> sizes;  ///< indices of parameters
  std::vector<double> nudge;
  MatrixXd d;
};

namespace {

using ChangedBy = std::function<VectorXd(const Placed&)>;

/// A nudge of the first size that changes z by about its noise, whatever the parameter's bounds.
double fitting_nudge(const Placed& shape, std::size_t size, const ChangedBy& changed_by) {
  constexpr double of_bounds = 3e-3, least = 1e-4, most = 100;  // chosen
  Placed nudged = shape;
  const effects::Parameter p = effects::parameters(nudged.effect)[size];
  const double first = of_bounds * (p.bounds.high > 0 ? p.bounds.high : p.bounds.low);
  *p.value += first;
  const VectorXd change = changed_by(nudged);
  const double rms = change.norm() / std::sqrt(double(change.size()));
  const double scale = std::clamp(0.3 / std::max(rms, 1e-12), least, most);
  return std::min(first * scale, p.bounds.high - (*p.value - first));
}

Directions directions(const Placed& shape, const ChangedBy& changed_by) {
  Directions all{shape, {}, {}, {}};
  effects::AnyEffect probe = shape.effect;
  const auto parameters = effects::parameters(probe);
  for (std::size_t p = 0; p < parameters.size(); ++p)
    if (!shapes(parameters[p]) && parameters[p].fitted) all.sizes.push_back(p);
  const double first = fitting_nudge(shape, all.sizes[0], changed_by);
  for (std::size_t n = 0; n < all.sizes.size(); ++n) {
    const effects::Bounds bounds = parameters[all.sizes[n]].bounds;
    const bool same = bounds.high == parameters[all.sizes[0]].bounds.high;
    all.nudge.push_back(n == 0 || same ? first : 0.03 * bounds.high);
    Placed nudged = shape;
    const auto values = effects::parameters(nudged.effect);
    *values[all.sizes[n]].value += all.nudge[n];
    if (n > 0) *values[all.sizes[0]].value += first;  // a place means nothing without a size
    const VectorXd change = changed_by(nudged);
    if (n == 0) all.d.resize(change.size(), Index(all.sizes.size()));
    all.d.col(Index(n)) = change;
    if (n > 0) all.d.col(Index(n)) -= all.d.col(0);
  }
  return all;
}

}  // namespace

/// By the linear model of `base`, where its unknowns moved, with what an effect changes in z.
double Screen::cost_at(const Estimate& base, const Left& left, const VectorXd& changed,
                       const VectorXd& moved) const {
  Point after = base.point;
  for (std::size_t k = 0; k < after.x.size(); ++k) after.x[k] += moved[Index(k)];
  const ResidualVector& residuals = train_.residuals();
  const VectorXd z = base.z + changed + base.jacobian * moved;
  return misfit(left_by(residuals, left, z), residuals) + prior_cost(uncertain_, after);
}

/// Of one shape: the values that would explain most, and what they would explain.
Candidate Screen::score(const Estimate& base, const Left& left, const Directions& all) const {
  const MatrixXd wd = base.weight.asDiagonal() * all.d;
  const MatrixXd shared = base.covariance * (base.jacobian.transpose() * wd);
  MatrixXd own = all.d.transpose() * wd;
  const MatrixXd whole = own;
  own -= wd.transpose() * base.jacobian * shared;
  constexpr double copy = 1e-6;  // of its square: below, a copy of what is estimated already
  Candidate candidate{all.shape, 0};
  if (!(own(0, 0) > copy * whole(0, 0)) || !(whole(0, 0) > 0)) return candidate;
  for (Index n = 1; n < own.rows(); ++n) own(n, n) += 1e-6 * whole(n, n) + 1e-12;
  const VectorXd step =
      -own.ldlt().solve(wd.transpose() * base.z - shared.transpose() * base.gradient);
  const auto values = effects::parameters(candidate.start.effect);
  const effects::Parameter& size = values[all.sizes[0]];
  const double sized = *size.value + step[0] * all.nudge[0];
  if (sized < size.bounds.low || sized > size.bounds.high) return candidate;
  const VectorXd moved = -(base.covariance * base.gradient);
  candidate.score = cost_at(base, left, VectorXd::Zero(base.z.size()), moved) -
                    cost_at(base, left, all.d * step, moved - shared * step);
  for (std::size_t n = 0; n < all.sizes.size(); ++n) {
    const effects::Parameter& p = values[all.sizes[n]];
    const bool place = n > 0 && p.bounds.high != size.bounds.high;
    const double by = place ? step[Index(n)] / step[0] : step[Index(n)];
    *p.value = std::clamp(*p.value + by * all.nudge[n], p.bounds.low, p.bounds.high);
  }
  return candidate;
}

Candidate Screen::best_shape(const Estimate& base, const Left& left, const Placed& neutral) const {
  const erp::Robot robot = robot_at(uncertain_, base.point);
  const residuals::Reach reach = residuals::Stages(robot).reach(neutral);
  const ChangedBy changed_by = [&](const Placed& placed) -> VectorXd {
    erp::Robot with = robot;
    with.effects.push_back(effects::written(placed));
    return train_.residuals().z(train_.residuals().explain(with, base.explained, reach)) - base.z;
  };
  Candidate best{neutral, 0};
  for (const Placed& shape : shaped(neutral))
    if (Candidate one = score(base, left, directions(shape, changed_by)); one.score > best.score)
      best = std::move(one);
  return best;
}

bool Screen::is_searched(const effects::About& about) const {
  if (about.stage == effects::Stage::bus || about.type.ends_with("_quantisation")) return false;
  if (std::ranges::count(withhold_, about.type)) return false;
  return std::ranges::none_of(uncertain_.constants,
                              [&](const Constant& c) { return about.type == c.effect; });
}

std::vector<Candidate> Screen::candidates(const Estimate& base) const {
  const Left left = left_by(train_.residuals(), base.explained, base.z);
  std::vector<Placed> all;
  for (const effects::AnyEffect& effect : effects::library()) {
    const effects::About& about = effects::about(effect);
    if (!is_searched(about)) continue;
    for (const std::string& on : effects::places(uncertain_.nominal, about.seat))
      if (can_show({on, effect}, uncertain_.nominal, train_.residuals().episodes()) &&
          std::ranges::none_of(base.point.effects, [&](const Placed& p) {
            return p.on == on && p.effect.index() == effect.index();
          }))
        all.push_back({on, effect});
  }
  std::vector<Candidate> screened(all.size());
  in_parallel(all.size(), train_.options().threads,
              [&](std::size_t k) { screened[k] = best_shape(base, left, all[k]); });
  std::erase_if(screened, [](const Candidate& c) { return !(c.score > 0); });
  std::ranges::stable_sort(screened, std::greater(), &Candidate::score);
  return screened;
}

}  // namespace sim::gap
