#include "sim/learning/sensorimotor/experiment.hpp"

#include <stdexcept>

namespace sim::sensorimotor {
namespace {

using Eigen::VectorXd;

/// The k-th of `count` equally spaced values in −half … half; 0 if there is only one.
double spaced(int k, int count, double half) {
  return count == 1 ? 0 : half * (2.0 * k / (count - 1) - 1);
}

}  // namespace

std::vector<Goal> goals_of(const Experiment& experiment, Eigen::Index senses) {
  std::vector<Goal> goals;
  const auto add = [&](const xml::Place& place, const VectorXd& target) {
    if (target.size() != senses)
      throw std::invalid_argument(place.file + ":" + std::to_string(place.line) +
                                  ": the goal has " + std::to_string(target.size()) +
                                  " senses, the cameras give " + std::to_string(senses) +
                                  "; give two per camera");
    goals.push_back({target, VectorXd::Zero(senses), {}});
  };
  for (const Grid& grid : experiment.grids)
    for (int row = 0; row < grid.rows; ++row)
      for (int column = 0; column < grid.columns; ++column)
        add(grid.place, Eigen::Vector2d(spaced(column, grid.columns, grid.half_width),
                                        spaced(row, grid.rows, grid.half_height)));
  for (const GoalAt& goal : experiment.goals)
    add(goal.place, Eigen::Map<const VectorXd>(goal.at.data(), std::ssize(goal.at)));
  return goals;
}

}  // namespace sim::sensorimotor
