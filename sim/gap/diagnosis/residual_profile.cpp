#include "sim/gap/diagnosis/residual_profile.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace sim::diagnosis {
namespace {

constexpr std::size_t bins = 16;                // chosen
constexpr std::size_t min_windows_per_bin = 5;  // chosen
constexpr const char* time_name = "time";

/// Residuals of one stage with their variables, over several recordings.
struct Sample {
  std::vector<Variable> variables;
  std::vector<double> residual;  ///< units of noise
};

Sample sample(const Evaluator& evaluator, const Evaluation& evaluation, effects::Stage stage,
              const std::string& on, std::span<const std::size_t> episodes) {
  Sample all;
  for (const std::size_t e : episodes) {
    const auto z = evaluator.whitened(evaluation, e);
    auto recorded_variables = variables(evaluator, e, stage, on);
    if (all.variables.empty())
      for (const Variable& v : recorded_variables) all.variables.push_back({v.name, v.unit, {}});
    std::size_t first = 0;
    const auto& nominal_evaluation = evaluator.nominal_evaluation().of_episode[e].residuals;
    const auto& changed = evaluation.of_episode[e].residuals;
    for (std::size_t n = 0; n < nominal_evaluation.size(); ++n) {
      const residuals::Residual& r = nominal_evaluation[n];
      if (r.stage == stage && r.on == on)
        for (std::size_t k = 0; k < r.value.size(); ++k) {
          const bool available = n < changed.size() && !std::isnan(changed[n].value[k]);
          const residuals::Residual& available_residual = available ? changed[n] : r;
          const bool within_band =
              residuals::banded(available_residual, k) && available_residual.value[k] == 0;
          if (std::isnan(z[first + k]) || within_band) continue;
          all.residual.push_back(z[first + k]);
          for (std::size_t v = 0; v < recorded_variables.size(); ++v)
            all.variables[v].value.push_back(recorded_variables[v].value[k]);
        }
      first += r.value.size();
    }
  }
  return all;
}

/// Mean residual by bin of a variable.
struct Map {
  double low = 0, width = 1;
  std::array<double, bins> sum{}, square{};
  std::array<std::size_t, bins> count{};

  std::size_t bin(double x) const {
    return static_cast<std::size_t>(std::clamp((x - low) / width, 0.0, double(bins) - 1));
  }
  double mean(std::size_t b) const {
    return count[b] >= min_windows_per_bin ? sum[b] / static_cast<double>(count[b]) : 0;
  }
};

Map map_of(const std::vector<double>& x, const std::vector<double>& r) {
  std::vector<double> sorted;
  for (const double v : x)
    if (!std::isnan(v)) sorted.push_back(v);
  if (sorted.size() < bins * min_windows_per_bin) return {};
  std::ranges::sort(sorted);
  const double low = sorted[sorted.size() / 100], high = sorted[sorted.size() * 99 / 100];
  Map map{low, std::max((high - low) / bins, 1e-12), {}, {}, {}};
  for (std::size_t k = 0; k < x.size(); ++k) {
    if (std::isnan(x[k])) continue;
    const std::size_t b = map.bin(x[k]);
    map.sum[b] += r[k], map.square[b] += r[k] * r[k], ++map.count[b];
  }
  return map;
}

/// Σ (r − m)²
double remaining_residual(const Map& map, const std::vector<double>& x,
                          const std::vector<double>& r) {
  double remaining = 0;
  for (std::size_t k = 0; k < x.size(); ++k)
    remaining += std::pow(r[k] - (std::isnan(x[k]) ? 0 : map.mean(map.bin(x[k]))), 2);
  return remaining;
}

/// Σ (r − m)² with a constant m.
double remaining_residual(double mean, const std::vector<double>& r) {
  double remaining = 0;
  for (const double one : r) remaining += std::pow(one - mean, 2);
  return remaining;
}

double mean_of(const std::vector<double>& r) {
  double sum = 0;
  for (const double one : r) sum += one;
  return r.empty() ? 0 : sum / static_cast<double>(r.size());
}

/// Explained part of the residual above noise. `remaining`: Σ r² after the explanation.
double explained(double remaining, const std::vector<double>& r) {
  const double before = remaining_residual(0, r);
  const auto n = static_cast<double>(r.size());
  constexpr double least_ratio = 1.05;  // of Σ r² to that of noise; chosen
  return before > least_ratio * n ? std::min(1.0, (before - remaining) / (before - n)) : 0;
}

}  // namespace

std::vector<Variable> variables(const Evaluator& evaluator, std::size_t episode,
                                effects::Stage stage, const std::string& on) {
  const residuals::Explanation& e = evaluator.nominal_evaluation().of_episode[episode];
  const residuals::Episode& recorded = evaluator.episodes()[episode];
  const residuals::Bump bump(residuals::Windows{}.half_width_s, recorded.period_s);
  std::vector<Variable> all;
  const auto add = [&](const char* name, const char* unit, const residuals::Signal& signal,
                       bool rate) {
    if (signal.empty()) return;
    Variable v{name, unit, {}};
    for (const std::size_t row : e.rows)
      v.value.push_back(rate ? bump.rate(signal, row) : bump.mean(signal, row));
    all.push_back(std::move(v));
  };
  Variable time{time_name, "s", {}};
  for (const std::size_t row : e.rows) time.value.push_back(double(row) * recorded.period_s);
  const erp::Robot& robot = evaluator.nominal();
  if (stage == effects::Stage::joint) {
    const auto joints = robot.joints();
    for (std::size_t j = 0; j < joints.size(); ++j)
      if (joints[j].name == on) {
        add("joint angle", "rad", e.joints->signals[j].angle_rad, false);
        add("joint speed", "rad/s", e.joints->signals[j].angle_rad, true);
      }
  } else {
    for (std::size_t a = 0; a < robot.actuators.size(); ++a) {
      if (robot.actuators[a].name != on) continue;
      const residuals::ActuatorSignals& s = recorded.actuators[a];
      add("shaft angle", "rad", s.shaft_rad, false), add("shaft speed", "rad/s", s.shaft_rad, true);
      add("tension", "N", s.tension_N, false), add("current", "A", s.current_A, false);
      add("voltage", "V", s.voltage_V, false);
      add("tension's rate", "N/s", s.tension_N, true);
      add("path length", "m", e.paths[a]->length_m, false);
    }
  }
  all.push_back(std::move(time));
  return all;
}

std::optional<ResidualProfile> residual_profile(const Evaluator& evaluator,
                                                const Evaluation& evaluation, effects::Stage stage,
                                                const std::string& on,
                                                std::span<const std::size_t> train,
                                                std::span<const std::size_t> held_out) {
  const Sample training = sample(evaluator, evaluation, stage, on, train);
  const Sample held_out_sample = sample(evaluator, evaluation, stage, on, held_out);
  const double constant = std::max(
      0.0, explained(remaining_residual(mean_of(training.residual), held_out_sample.residual),
                     held_out_sample.residual));
  std::optional<ResidualProfile> best;
  for (std::size_t v = 0; v < training.variables.size() && v < held_out_sample.variables.size();
       ++v) {
    const Map map = map_of(training.variables[v].value, training.residual);
    const double share = explained(
        remaining_residual(map, held_out_sample.variables[v].value, held_out_sample.residual),
        held_out_sample.residual);
    if (best && share <= best->explained) continue;
    best = ResidualProfile{
        training.variables[v].name,      training.variables[v].unit, {}, {}, {}, share,
        std::clamp(share, 0.0, constant)};
    for (std::size_t b = 0; b < bins; ++b) {
      if (map.count[b] < min_windows_per_bin) continue;
      const double mean = map.mean(b), n = static_cast<double>(map.count[b]);
      best->middle.push_back(map.low + (double(b) + 0.5) * map.width);
      best->mean.push_back(mean);
      best->deviation.push_back(std::sqrt(std::max(0.0, map.square[b] / n - mean * mean)));
    }
  }
  return best;
}

double explained_by_one_variable(const Evaluator& evaluator, const Evaluation& evaluation,
                                 effects::Stage stage, const std::string& on, const Sets& sets) {
  if (sets.held_out == sets.train) return 0;
  const Sample training = sample(evaluator, evaluation, stage, on, sets.train);
  const Sample held_out_sample = sample(evaluator, evaluation, stage, on, sets.held_out);
  if (training.residual.empty() || held_out_sample.residual.empty()) return 0;
  const double baseline = remaining_residual(mean_of(training.residual), held_out_sample.residual);
  const double beyond_noise = remaining_residual(0, held_out_sample.residual) -
                              static_cast<double>(held_out_sample.residual.size());
  double largest = 0;
  for (std::size_t v = 0; v < training.variables.size(); ++v) {
    if (training.variables[v].name == time_name) continue;
    const Map map = map_of(training.variables[v].value, training.residual);
    const double remaining =
        remaining_residual(map, held_out_sample.variables[v].value, held_out_sample.residual);
    largest = std::max(largest, beyond_noise > 0 ? (baseline - remaining) / beyond_noise : 0);
  }
  return largest;
}

std::vector<Region> regions(const Evaluator& evaluator, const Evaluation& evaluation,
                            effects::Stage stage, const std::string& on,
                            std::span<const std::size_t> episodes) {
  constexpr const char* fifths[] = {"lowest", "low", "middle", "high", "highest"};
  constexpr double smallest_share = 0.35;  // of Σ r² in a fifth of the windows; chosen
  const Sample all = sample(evaluator, evaluation, stage, on, episodes);
  double total = 0;
  for (const double r : all.residual) total += r * r;
  std::vector<Region> found;
  const auto add = [&](const std::string& name, const std::vector<double>& x) {
    std::vector<std::size_t> order;
    for (std::size_t k = 0; k < x.size(); ++k)
      if (!std::isnan(x[k])) order.push_back(k);
    std::ranges::sort(order, {}, [&](std::size_t k) { return x[k]; });
    std::array<double, 5> share{};
    for (std::size_t k = 0; k < order.size(); ++k)
      share[k * 5 / order.size()] += all.residual[order[k]] * all.residual[order[k]] / total;
    for (std::size_t f = 0; f < 5; ++f)
      if (share[f] > smallest_share) found.push_back({name, fifths[f], share[f]});
  };
  for (const Variable& v : all.variables) {
    add(v.name, v.value);
    if (!v.name.ends_with("speed")) continue;
    std::vector<double> size = v.value;
    for (double& x : size) x = std::abs(x);
    add("size of " + v.name, size);  // the lowest fifth contains the reversals
  }
  std::ranges::stable_sort(found, std::greater(), &Region::share);
  return found;
}

}  // namespace sim::diagnosis
