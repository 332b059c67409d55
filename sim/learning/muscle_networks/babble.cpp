#include "sim/learning/muscle_networks/babble.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "interfaces/values.hpp"

namespace sim::muscle_networks {

recording::Table babble(const erp::Robot& robot, const BabbleOptions& options) {
  std::mt19937_64 random(options.seed);
  std::exponential_distribution<double> pull(1 / options.mean_N);
  recording::Table table{{{"time_s", {}}}};
  for (const erp::Actuator& actuator : robot.actuators) {
    table.columns.push_back({actuator.name + ".mode", {}});
    table.columns.push_back({actuator.name + ".reference", {}});
  }
  for (double time_s = 0; time_s <= options.duration_s; time_s += options.every_s) {
    table.columns[0].values.push_back(time_s);
    for (std::size_t a = 0; a < robot.actuators.size(); ++a) {
      const erp::Actuator& actuator = robot.actuators[a];
      const double drawn_N =
          std::min(options.least_N + pull(random),
                   std::max(options.least_N, options.share * actuator.max_tension_N));
      const double start_N = std::max(options.least_N, actuator.tendon.pretension_N);
      table.columns[1 + 2 * a].values.push_back(static_cast<double>(erp::Mode::force));
      table.columns[2 + 2 * a].values.push_back(std::round(10 * (time_s == 0 ? start_N : drawn_N)) /
                                                10);
    }
  }
  return table;
}

}  // namespace sim::muscle_networks
