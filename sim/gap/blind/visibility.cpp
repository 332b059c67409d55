#include "sim/gap/blind/visibility.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace sim::blind {
namespace {

constexpr double seconds = 20;

double rms(const std::vector<double>& a, const std::vector<double>& b) {
  const std::size_t rows = std::min(a.size(), b.size());
  double square = 0;
  for (std::size_t k = 0; k < rows; ++k) square += (a[k] - b[k]) * (a[k] - b[k]);
  return rows > 0 ? std::sqrt(square / double(rows)) : 0;
}

bool is_read(const std::string& column) {
  return column != "time_s" && !column.ends_with(".mode") && !column.ends_with(".reference");
}

recording::Table read(const erp::Robot& robot, const HiddenEffects& hidden_effects,
                      const Excitation& excitation, std::uint64_t seed) {
  Case blind;
  blind.hidden_effects = hidden_effects;
  return record(robot, blind, excitation, seed);
}

}  // namespace

Visibility::Visibility(const erp::Robot& robot) : robot_(robot) {
  HiddenEffects none;
  none.chains.resize(robot.actuators.size()), none.joints.resize(robot.joints().size());
  for (const int kind : {0, 1}) {
    Walk walk{excitation(robot, kind, seconds, 1), {}, {}};
    walk.plain = read(robot, none, walk.excitation, 1);
    const auto again = read(robot, none, walk.excitation, 2);
    for (std::size_t c = 0; c < walk.plain.columns.size(); ++c) {
      const auto& [name, values] = walk.plain.columns[c];
      walk.noise.push_back(is_read(name) ? rms(values, again.columns[c].values) / std::sqrt(2.0)
                                         : 0);
    }
    walks_.push_back(std::move(walk));
  }
}

bool Visibility::operator()(const HiddenEffects& hidden_effects) const {
  return std::ranges::any_of(walks_, [&](const Walk& walk) {
    try {
      const auto now = read(robot_, hidden_effects, walk.excitation, 1);
      for (std::size_t c = 0; c < now.columns.size(); ++c)
        if (walk.noise[c] > 0 &&
            rms(now.columns[c].values, walk.plain.columns[c].values) > walk.noise[c])
          return true;
      return false;
    } catch (const NotFinite&) {
      return true;
    }
  });
}

}  // namespace sim::blind
