#include "sim/gap/search.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>

#include "sim/parallel/in_parallel.hpp"

namespace sim::gap {
namespace {

using effects::Placed;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double left_excess = 0.6;  // of a stage: below, no effect is looked for; chosen
constexpr double worth = 0.3;        // of a stage's excess that an effect must take away; chosen

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

/// What a constant stands for already, and what no residual shows.
bool is_searched(const effects::About& about, const Uncertain& uncertain,
                 const std::vector<std::string>& withhold) {
  if (about.stage == effects::Stage::bus || about.type.ends_with("_quantisation")) return false;
  if (std::ranges::count(withhold, about.type)) return false;
  return std::ranges::none_of(uncertain.constants,
                              [&](const Constant& c) { return about.type == c.effect; });
}

}  // namespace

std::vector<double> excess(const ResidualVector& residuals, const VectorXd& z) {
  constexpr double median_of_chi_square = 0.455, event = 36;  // six deviations; chosen
  std::vector<std::vector<double>> square(residuals.stages());
  for (const Block& b : residuals.blocks())
    for (Index k = b.first; k < b.first + b.count; ++k)
      if (z[k] != 0) square[b.stage].push_back(z[k] * z[k]);
  std::vector<double> all;
  for (auto& of_stage : square) {
    if (of_stage.empty()) {
      all.push_back(0);
      continue;
    }
    const auto middle = of_stage.begin() + std::ptrdiff_t(of_stage.size() / 2);
    std::ranges::nth_element(of_stage, middle);
    const double most = event * std::max(1.0, *middle / median_of_chi_square);
    double sum = 0;
    for (const double x : of_stage) sum += std::min(x, most);
    all.push_back(sum / double(of_stage.size()) - 1);
  }
  return all;
}

Search::Search(const Estimator& train, const ResidualVector& held_out, const Uncertain& uncertain,
               const SearchOptions& options)
    : train_(train), held_out_(held_out), uncertain_(uncertain), options_(options) {}

Found Search::judge(Estimate estimate) const {
  Found found{std::move(estimate), {}, {}};
  found.held_out = held_out_.explain(robot_at(uncertain_, found.train.point), 1);
  found.z_held_out = held_out_.z(found.held_out);
  return found;
}

/// −2 log L of stages whose variance is not known but no less than that of the noise:
/// Σ_s n_s log max(1, ⟨z_s²⟩), n_s: independent windows.
double Search::profile(const Estimate& base, const VectorXd& z) const {
  const auto left = excess(train_.residuals(), z);
  std::vector<double> windows(left.size());
  for (const Block& b : train_.residuals().blocks())
    windows[b.stage] +=
        double(b.count) * base.weight[b.first] * std::max(1.0, base.mean_square[b.stage]);
  double sum = 0;
  for (std::size_t s = 0; s < left.size(); ++s)
    sum += windows[s] * std::log1p(std::max(0.0, left[s]));
  return sum;
}

double Search::cost(const Found& found, const Estimate& base) const {
  const auto left = excess(held_out_, found.z_held_out);
  std::vector<double> windows(left.size());
  const auto blocks = train_.residuals().blocks();
  for (const Block& b : held_out_.blocks()) {
    const auto same = std::ranges::find(blocks, b.stage, &Block::stage);
    windows[b.stage] +=
        double(b.count) * base.weight[same->first] * std::max(1.0, base.mean_square[b.stage]);
  }
  double sum = 0;
  for (std::size_t s = 0; s < left.size(); ++s)
    sum += windows[s] * std::log1p(std::max(0.0, left[s]));
  for (std::size_t k = 0; k < found.train.point.x.size(); ++k)
    sum += std::pow(found.train.point.x[k] / uncertain_.prior[k], 2);
  return sum;
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

/// Of one shape: the values that would explain most, and what they would explain.
Candidate Search::screen(const Estimate& base, const Directions& all) const {
  const MatrixXd wd = base.weight.asDiagonal() * all.d;
  const MatrixXd shared = base.covariance * (base.jacobian.transpose() * wd);
  MatrixXd own = all.d.transpose() * wd;
  const MatrixXd whole = own;
  own -= wd.transpose() * base.jacobian * shared;
  constexpr double copy = 1e-3;  // of its square: less is a copy of what is estimated already
  Candidate candidate{all.shape, 0};
  if (!(own(0, 0) > copy * whole(0, 0)) || !(whole(0, 0) > 0)) return candidate;
  for (Index n = 1; n < own.rows(); ++n) own(n, n) += 1e-6 * whole(n, n) + 1e-12;
  const VectorXd step =
      -own.ldlt().solve(wd.transpose() * base.z - shared.transpose() * base.gradient);
  const auto values = effects::parameters(candidate.start.effect);
  const effects::Parameter& size = values[all.sizes[0]];
  const double sized = *size.value + step[0] * all.nudge[0];
  if (sized < size.bounds.low || sized > size.bounds.high) return candidate;
  const VectorXd z =
      base.z + all.d * step - base.jacobian * (base.covariance * base.gradient + shared * step);
  candidate.score = profile(base, base.z) - profile(base, z);
  for (std::size_t n = 0; n < all.sizes.size(); ++n) {
    const effects::Parameter& p = values[all.sizes[n]];
    const bool place = n > 0 && p.bounds.high != size.bounds.high;
    const double by = place ? step[Index(n)] / step[0] : step[Index(n)];
    *p.value = std::clamp(*p.value + by * all.nudge[n], p.bounds.low, p.bounds.high);
  }
  return candidate;
}

Candidate Search::screen(const Estimate& base, const Placed& neutral) const {
  const erp::Robot robot = robot_at(uncertain_, base.point);
  const residuals::Reach reach = residuals::Stages(robot).reach(neutral);
  const ChangedBy changed_by = [&](const Placed& placed) -> VectorXd {
    erp::Robot with = robot;
    with.effects.push_back(effects::written(placed));
    return train_.residuals().z(train_.residuals().explain(with, base.explained, reach)) - base.z;
  };
  Candidate best{neutral, 0};
  for (const Placed& shape : shaped(neutral))
    if (Candidate one = screen(base, directions(shape, changed_by)); one.score > best.score)
      best = std::move(one);
  return best;
}

std::vector<Candidate> Search::screen(const Estimate& base) const {
  std::vector<Placed> all;
  for (const effects::AnyEffect& effect : effects::library()) {
    const effects::About& about = effects::about(effect);
    if (!is_searched(about, uncertain_, options_.withhold)) continue;
    for (const std::string& on : effects::places(uncertain_.nominal, about.seat))
      if (std::ranges::none_of(base.point.effects, [&](const Placed& p) {
            return p.on == on && p.effect.index() == effect.index();
          }))
        all.push_back({on, effect});
  }
  std::vector<Candidate> screened(all.size());
  in_parallel(all.size(), train_.options().threads,
              [&](std::size_t k) { screened[k] = screen(base, all[k]); });
  std::erase_if(screened, [](const Candidate& c) { return !(c.score > 0); });
  std::ranges::stable_sort(screened, std::greater(), &Candidate::score);
  return screened;
}

std::optional<Found> Search::best_beside(const Found& base) const {
  constexpr int iterations = 4;
  auto candidates = screen(base.train);
  if (candidates.size() > options_.estimated) candidates.resize(options_.estimated);
  std::vector<std::optional<Found>> joined(candidates.size());
  in_parallel(candidates.size(), train_.options().threads, [&](std::size_t k) {
    Point start = base.train.point;
    start.effects.push_back(candidates[k].start);
    joined[k] = judge(train_.beside(uncertain_, base.train, std::move(start), iterations));
  });
  const auto best =
      std::ranges::min_element(joined, {}, [&](const auto& j) { return cost(*j, base.train); });
  if (best == joined.end()) return std::nullopt;
  const auto was = excess(held_out_, base.z_held_out), is = excess(held_out_, (*best)->z_held_out);
  for (std::size_t s = 0; s < was.size(); ++s)
    if (was[s] > left_excess && was[s] - is[s] > worth * was[s] &&
        cost(**best, base.train) < cost(base, base.train)) {
      return judge(train_.run(uncertain_, (*best)->train.point));
    }
  return std::nullopt;
}

/// An earlier choice may have been a compromise between two: each is looked for again beside the others.
Found Search::exchanged(Found found) const {
  for (std::size_t k = 0;
       found.train.point.effects.size() > 1 && k + 1 < found.train.point.effects.size(); ++k) {
    Point others = found.train.point;
    others.effects.erase(others.effects.begin() + std::ptrdiff_t(k));
    const Found without = judge(train_.run(uncertain_, others));
    const auto other = best_beside(without);
    constexpr double better = 0.98;  // chosen
    if (other && cost(*other, without.train) < better * cost(found, without.train)) found = *other;
  }
  return found;
}

Found Search::run(Estimate base) const {
  Found found = judge(std::move(base));
  const auto keeps = [&](const Found& f) {
    const auto train = excess(train_.residuals(), f.train.z),
               held = excess(held_out_, f.z_held_out);
    return std::ranges::any_of(train, [](double e) { return e > left_excess; }) ||
           std::ranges::any_of(held, [](double e) { return e > left_excess; });
  };
  while (keeps(found) && found.train.point.effects.size() < options_.most_effects) {
    report(double(found.train.point.effects.size()) / double(options_.most_effects));
    auto more = best_beside(found);
    if (!more) break;
    found = exchanged(std::move(*more));
  }
  return found;
}

}  // namespace sim::gap
