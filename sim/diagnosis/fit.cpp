#include "sim/diagnosis/fit.hpp"

#include <ceres/ceres.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace sim::diagnosis {
namespace {

/// A parameter as the optimiser sees it: u = 1 + value/scale, so that a step relative to u is one
/// relative to the scale.
struct Knob {
  double* value;
  effects::Bounds bounds;
  double scale;

  double to_u(double v) const { return 1 + v / scale; }
  double to_value(double u) const { return std::clamp((u - 1) * scale, bounds.low, bounds.high); }
};

std::vector<Knob> knobs_of(effects::AnyEffect& effect) {
  std::vector<Knob> knobs;
  for (const effects::Parameter& p : effects::parameters(effect))
    if (p.fitted)
      knobs.push_back({p.value, p.bounds, std::max(std::abs(p.bounds.low), p.bounds.high)});
  return knobs;
}

using Effects = std::vector<effects::Placed>;

/// Σ z² of a trial as a cost for Ceres.
struct Cost {
  std::function<Trial(const Effects&)> tried;
  const Trials& trials;
  std::span<const std::size_t> episodes;
  Effects& effects;
  std::vector<Knob>& knobs;
  std::size_t residuals;

  bool operator()(double const* const* u, double* z) const {
    for (std::size_t k = 0; k < knobs.size(); ++k) *knobs[k].value = knobs[k].to_value(u[0][k]);
    const Trial trial = tried(effects);
    std::size_t n = 0;
    for (const std::size_t e : episodes)
      for (const double one : trials.whitened(trial, e)) z[n++] = std::isnan(one) ? 0 : one;
    return true;
  }
};

struct Least {
  double square;
  std::vector<double> u, sigma;
};

Eigen::MatrixXd dense(const ceres::CRSMatrix& sparse) {
  Eigen::MatrixXd j = Eigen::MatrixXd::Zero(sparse.num_rows, sparse.num_cols);
  for (int row = 0; row < sparse.num_rows; ++row)
    for (int n = sparse.rows[std::size_t(row)]; n < sparse.rows[std::size_t(row) + 1]; ++n)
      j(row, sparse.cols[std::size_t(n)]) = sparse.values[std::size_t(n)];
  return j;
}

/// σ of each parameter, √(JᵀJ)⁻¹ₖₖ; infinite where nothing changes with it, or nothing that another
/// would not change alike.
std::vector<double> deviations(const Eigen::MatrixXd& j) {
  constexpr double infinite = std::numeric_limits<double>::infinity(), nothing = 1e-9;
  const Eigen::VectorXd length = j.colwise().norm().transpose();
  const Eigen::VectorXd scale = (length.array() > 0).select(length.cwiseInverse(), 0.0);
  const Eigen::MatrixXd cosines = scale.asDiagonal() * (j.transpose() * j) * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(cosines);
  std::vector<double> sigma;
  for (Eigen::Index k = 0; k < j.cols(); ++k) {
    double variance = 0;
    for (Eigen::Index n = 0; n < j.cols(); ++n) {
      const double part = std::pow(axes.eigenvectors()(k, n), 2), along = axes.eigenvalues()[n];
      if (part > nothing) variance += along > nothing ? part / along : infinite;
    }
    sigma.push_back(length[k] > 0 ? std::sqrt(variance) / length[k] : infinite);
  }
  return sigma;
}

/// From u; sigma in the parameters' units, wider by what noise does not explain.
Least minimise(const Cost& given, std::vector<double> u, int iterations) {
  constexpr double step = 2e-4;  // chosen: of the scale
  ceres::NumericDiffOptions differences;
  differences.relative_step_size = step;
  auto* cost = new ceres::DynamicNumericDiffCostFunction<Cost, ceres::FORWARD>(
      new Cost(given), ceres::TAKE_OWNERSHIP, differences);
  const int count = static_cast<int>(u.size());
  cost->AddParameterBlock(count);
  cost->SetNumResiduals(static_cast<int>(given.residuals));
  ceres::Problem problem;
  problem.AddResidualBlock(cost, nullptr, u.data());
  for (int k = 0; k < count; ++k) {
    const Knob& knob = given.knobs[static_cast<std::size_t>(k)];
    problem.SetParameterLowerBound(u.data(), k, knob.to_u(knob.bounds.low));
    problem.SetParameterUpperBound(u.data(), k, knob.to_u(knob.bounds.high) - 2 * step);
  }
  ceres::Solver::Options options;
  options.max_num_iterations = iterations;
  options.linear_solver_type = ceres::DENSE_QR;
  options.function_tolerance = 1e-5;
  options.parameter_tolerance = 1e-6;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);

  ceres::CRSMatrix sparse;
  std::vector<double> z;
  problem.Evaluate({}, nullptr, &z, nullptr, &sparse);
  const auto judged = static_cast<double>(z.size()) - double(std::ranges::count(z, 0.0));
  const double left = std::sqrt(std::max(1.0, 2 * summary.final_cost / std::max(1.0, judged)));
  Least least{2 * summary.final_cost, u, deviations(dense(sparse))};
  for (std::size_t k = 0; k < u.size(); ++k) least.sigma[k] *= left * given.knobs[k].scale;
  return least;
}

/// Where to begin: as given; and, for what shapes the law, at some shares of its bounds.
std::vector<std::vector<double>> starts(const std::vector<Knob>& knobs, bool given,
                                        const FitOptions& options) {
  constexpr double nudge = 2e-3;  // of the bounds, off a law's kink at its neutral value
  std::vector<std::vector<double>> all;
  std::vector<double> first;
  for (const Knob& knob : knobs) first.push_back(knob.to_u(*knob.value));
  if (!given) first[0] += knobs[0].bounds.high > 0 ? nudge : -nudge;
  all.push_back(first);
  if (given) return all;
  if (knobs.size() > 1 && knobs[1].bounds.low > 0)
    for (const double share : options.shape_starts) {
      const auto& [low, high] = knobs[1].bounds;
      all.push_back(first);
      all.back()[1] = knobs[1].to_u(low * std::pow(high / low, share));
    }
  return all;
}

/// A joint's stops, at or a little before where it turned back.
std::vector<effects::Placed> stops(const Trials& trials, const effects::Placed& neutral,
                                   std::span<const std::size_t> episodes) {
  const auto joints = trials.nominal().joints();
  const auto j = static_cast<std::size_t>(std::ranges::find(joints, neutral.on, &erp::Joint::name) -
                                          joints.begin());
  if (joints[j].type != erp::JointType::revolute) return {};
  double low = joints[j].max_rad, high = joints[j].min_rad;
  for (const std::size_t e : episodes)
    for (const double angle : trials.episodes()[e].joints[j].angle_rad)
      if (!std::isnan(angle)) low = std::min(low, angle), high = std::max(high, angle);
  std::vector<effects::Placed> all;
  for (const double before_rad : {0.0, 0.01, 0.02, 0.035, 0.05})
    for (const int side : {1, 2, 3}) {
      all.push_back(neutral);
      const auto parameters = effects::parameters(all.back().effect);
      if (side & 1)
        *parameters[0].value =
            std::clamp(low - joints[j].min_rad + before_rad, 0.0, parameters[0].bounds.high);
      if (side & 2)
        *parameters[1].value =
            std::clamp(joints[j].max_rad - high + before_rad, 0.0, parameters[1].bounds.high);
    }
  return all;
}

std::size_t count_residuals(const Trials& trials, std::span<const std::size_t> episodes) {
  std::size_t count = 0;
  for (const std::size_t e : episodes) count += trials.whitened(trials.bare(), e).size();
  return count;
}

bool is_neutral(const effects::Placed& placed) {
  return effects::written(placed).parameters.empty();
}

/// The one of the tries that leaves least, or the effect as given.
effects::Placed best_try(const Trials& trials, const Trial& base, const effects::Placed& more,
                         std::span<const std::size_t> episodes) {
  effects::Placed best = more;
  if (!is_neutral(more)) return best;
  double least = sum(trials.blocks(base, episodes)).square;
  auto all = tries(trials, more, episodes);
  for (const double share :
       {0.1, 0.02, -0.1}) {  // of the bounds: laws that are bent from the start
    all.push_back(more);
    const effects::Parameter first = effects::parameters(all.back().effect)[0];
    *first.value = share * (share > 0 ? first.bounds.high : -first.bounds.low);
    if (*first.value == 0) all.pop_back();
  }
  for (const effects::Placed& one : all)
    if (const double square = sum(trials.blocks(trials.with(base, one, episodes), episodes)).square;
        square < least)
      least = square, best = one;
  return best;
}

Fit result_of(const effects::Placed& placed, double square, std::span<const double> sigmas) {
  Fit fit{placed, square, {}, {sigmas.begin(), sigmas.end()}};
  for (const Knob& knob : knobs_of(fit.placed.effect)) fit.values.push_back(*knob.value);
  return fit;
}

}  // namespace

std::vector<effects::Placed> tries(const Trials& trials, const effects::Placed& neutral,
                                   std::span<const std::size_t> episodes) {
  const auto type = effects::about(neutral.effect).type;
  if (type == "joint_early_stop") return stops(trials, neutral, episodes);
  std::vector<effects::Placed> all;
  constexpr double soft = 0.7, stiff = 0.01, ratio = 0.8;  // rad/Nm
  if (type == "skeleton_link_flexibility")
    for (double c = soft; c > stiff; c *= ratio) {
      all.push_back(neutral);
      *effects::parameters(all.back().effect)[0].value = c;
    }
  return all;
}

Fit fit(const Trials& trials, const Trial& base, const effects::Placed& more,
        std::span<const std::size_t> episodes, const FitOptions& options) {
  Effects effects{best_try(trials, base, more, episodes)};
  std::vector<Knob> knobs = knobs_of(effects[0].effect);
  const Cost cost{[&](const Effects& e) { return trials.with(base, e[0], episodes); },
                  trials,
                  episodes,
                  effects,
                  knobs,
                  count_residuals(trials, episodes)};
  Least best{};
  for (const auto& start : starts(knobs, !is_neutral(effects[0]), options))
    if (Least least = minimise(cost, start, options.iterations);
        best.u.empty() || least.square < best.square)
      best = std::move(least);
  for (std::size_t k = 0; k < knobs.size(); ++k) *knobs[k].value = knobs[k].to_value(best.u[k]);
  return result_of(effects[0], best.square, best.sigma);
}

std::vector<Fit> fit_together(const Trials& trials, std::span<const effects::Placed> all,
                              std::span<const std::size_t> episodes, const FitOptions& options) {
  Effects effects(all.begin(), all.end());
  std::vector<Knob> knobs;
  std::vector<std::size_t> first;
  for (effects::Placed& placed : effects) {
    first.push_back(knobs.size());
    for (const Knob& knob : knobs_of(placed.effect)) knobs.push_back(knob);
  }
  first.push_back(knobs.size());
  const Cost cost{[&](const Effects& e) { return trials.with(e, episodes); },
                  trials,
                  episodes,
                  effects,
                  knobs,
                  count_residuals(trials, episodes)};
  std::vector<double> u;
  for (const Knob& knob : knobs) u.push_back(knob.to_u(*knob.value));
  const Least least = minimise(cost, u, options.iterations);
  for (std::size_t k = 0; k < knobs.size(); ++k) *knobs[k].value = knobs[k].to_value(least.u[k]);
  std::vector<Fit> fits;
  for (std::size_t n = 0; n < effects.size(); ++n)
    fits.push_back(result_of(effects[n], least.square,
                             std::span(least.sigma).subspan(first[n], first[n + 1] - first[n])));
  return fits;
}

}  // namespace sim::diagnosis
