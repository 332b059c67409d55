#include "sim/gap/blind/visibility.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace sim::blind {
namespace {

constexpr double duration_s = 20;  // chosen

double rms(const std::vector<double>& a, const std::vector<double>& b) {
  const std::size_t rows = std::min(a.size(), b.size());
  double square = 0;
  for (std::size_t k = 0; k < rows; ++k) square += (a[k] - b[k]) * (a[k] - b[k]);
  return rows > 0 ? std::sqrt(square / double(rows)) : 0;
}

bool is_reading(const std::string& column) {
  return column != "time_s" && !column.ends_with(".mode") && !column.ends_with(".reference");
}

recording::Table simulate(const erp::Robot& robot, const HiddenEffects& hidden_effects,
                          const Excitation& excitation, std::uint64_t seed) {
  Case blind;
  blind.hidden_effects = hidden_effects;
  return record(robot, blind, excitation, seed);
}

}  // namespace

Visibility::Visibility(const erp::Robot& robot) : robot_(robot) {
  HiddenEffects no_effects;
  no_effects.channels.resize(robot.actuators.size());
  no_effects.joints.resize(robot.joints().size());
  for (const int kind : {0, 1}) {
    Run run{excitation(robot, kind, duration_s, 1), {}, {}};
    run.without_effects = simulate(robot, no_effects, run.excitation, 1);
    // The difference of two runs with independent noise has twice the variance of the noise.
    const auto second = simulate(robot, no_effects, run.excitation, 2);
    for (std::size_t c = 0; c < run.without_effects.columns.size(); ++c) {
      const auto& [name, values] = run.without_effects.columns[c];
      run.noise.push_back(is_reading(name) ? rms(values, second.columns[c].values) / std::sqrt(2.0)
                                           : 0);
    }
    runs_.push_back(std::move(run));
  }
}

bool Visibility::operator()(const HiddenEffects& hidden_effects) const {
  return std::ranges::any_of(runs_, [&](const Run& run) {
    try {
      const auto with_effects = simulate(robot_, hidden_effects, run.excitation, 1);
      for (std::size_t c = 0; c < with_effects.columns.size(); ++c)
        if (run.noise[c] > 0 && rms(with_effects.columns[c].values,
                                    run.without_effects.columns[c].values) > run.noise[c])
          return true;
      return false;
    } catch (const NotFinite&) {
      return true;
    }
  });
}

}  // namespace sim::blind
