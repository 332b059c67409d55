#include "sim/learning/sensorimotor/learned_map_file.hpp"

#include <stdexcept>

namespace sim::sensorimotor {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

std::vector<double> numbers(const VectorXd& x) { return {x.begin(), x.end()}; }

/// Throws unless x has the given size.
VectorXd vector(const std::vector<double>& x, Index size, const xml::Place& place) {
  if (std::ssize(x) != size)
    throw std::invalid_argument(place.file + ":" + std::to_string(place.line) +
                                ": was learned with other muscles or cameras: " +
                                std::to_string(x.size()) + " numbers, not " + std::to_string(size));
  return Eigen::Map<const VectorXd>(x.data(), size);
}

}  // namespace

LearnedMapFile file_of(const LearnedMap& learned, const std::vector<Goal>& goals) {
  LearnedMapFile file{.squares = numbers(learned.squares_N2())};
  for (Index s = 0; s < learned.hebb().rows(); ++s)
    file.senses.push_back({{}, numbers(learned.hebb().row(s))});
  for (const Goal& goal : goals)
    file.goals.push_back({{}, numbers(goal.target), numbers(goal.alpha), goal.errors});
  return file;
}

LearnedMap learned_map_of(const LearnedMapFile& file, Index senses, Index muscles) {
  Eigen::MatrixXd hebb(senses, muscles);
  if (std::ssize(file.senses) != senses)
    throw std::invalid_argument(file.place.file + ": was learned with " +
                                std::to_string(file.senses.size()) + " senses, not " +
                                std::to_string(senses));
  for (Index s = 0; s < senses; ++s) {
    const SenseRow& row = file.senses[static_cast<std::size_t>(s)];
    hebb.row(s) = vector(row.weights, muscles, row.place);
  }
  return {hebb, vector(file.squares, muscles, file.place)};
}

std::vector<Goal> goals_of(const LearnedMapFile& file, Index senses) {
  std::vector<Goal> goals;
  for (const GoalRow& row : file.goals)
    goals.push_back(
        {vector(row.at, senses, row.place), vector(row.alpha, senses, row.place), row.errors});
  return goals;
}

}  // namespace sim::sensorimotor
