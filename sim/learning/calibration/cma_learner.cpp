#include "sim/learning/calibration/cma_learner.hpp"

#include <pagmo/algorithm.hpp>
#include <pagmo/algorithms/cmaes.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>
#include <pagmo/s11n.hpp>
#include <sstream>

#include "sim/learning/calibration/kept.hpp"

namespace sim::calibration {
namespace {

using pagmo::vector_double;

/// What pagmo asks for. Lent the task: the population does not outlive its learner.
struct Problem {
  const Task* task = nullptr;
  double bound = 0;

  vector_double fitness(const vector_double& x) const { return {error_rad(*task, vector(x))}; }
  std::pair<vector_double, vector_double> get_bounds() const {
    const auto size = task ? static_cast<std::size_t>(task->parameters.size()) : 1;
    return {vector_double(size, -bound), vector_double(size, bound)};
  }
  template <class Archive>
  void serialize(Archive&, unsigned) {}  // populations of it are not kept: only their points
};

/// The best so far comes first, then the population.
struct State {
  static constexpr auto element = "cma";
  xml::Place place;
  int generation = 0;
  std::string seed, algorithm;  ///< as pagmo writes it
  std::vector<Kept> list;
  void visit(auto& v) {
    v.required("generation", generation);
    v.required("seed", seed);
    v.required("algorithm", algorithm);
    v.list(list);
  }
};

pagmo::algorithm algorithm_of(const EvolutionOptions& o) {
  const double first_sigma = o.first_sigma / (2 * o.bound);  // pagmo's: of the bounds' distance
  constexpr double ours = -1, never = 0;  // pagmo's own rates; no stop of its own
  return pagmo::algorithm(pagmo::cmaes(1, ours, ours, ours, ours, first_sigma, never, never,
                                       /*memory=*/true, /*force_bounds=*/true,
                                       static_cast<unsigned>(o.seed)));
}

}  // namespace

struct CmaLearner::Inside {
  EvolutionOptions options;
  pagmo::algorithm algorithm;
  pagmo::population population;
  int generation = 0;
};

CmaLearner::CmaLearner(Task task, const EvolutionOptions& options)
    : Calibration(std::move(task)),
      inside_(new Inside{options, algorithm_of(options),
                         pagmo::population(Problem{&this->task(), options.bound}, 0u, 0u)}) {
  for (int k = 0; k < options.offspring; ++k)
    inside_->population.push_back(numbers(best()), {best_error_rad()});
}
CmaLearner::~CmaLearner() = default;

void CmaLearner::round(const Pool&) {
  inside_->population = inside_->algorithm.evolve(inside_->population);
  ++inside_->generation;
  const auto& population = inside_->population;
  const auto first = population.best_idx();
  found(vector(population.get_x()[first]), population.get_f()[first].front());
}

int CmaLearner::rounds() const { return inside_->generation; }

long CmaLearner::judged_poses() const {
  return std::ssize(task().poses.learn) * inside_->options.offspring * rounds();
}

std::string CmaLearner::state() const {
  std::ostringstream algorithm;
  boost::archive::text_oarchive(algorithm) << inside_->algorithm;
  State state{{}, rounds(), std::to_string(inside_->options.seed), algorithm.str(), {}};
  state.list.push_back({{}, numbers(best()), {}, best_error_rad()});
  const auto& population = inside_->population;
  for (std::size_t k = 0; k < population.size(); ++k)
    state.list.push_back({{}, population.get_x()[k], {}, population.get_f()[k].front()});
  return xml::write(state);
}

void CmaLearner::restore(const std::string& text, const std::string& file) {
  const auto state = xml::parse<State>(text, file);
  bool same = state.seed == std::to_string(inside_->options.seed) &&
              std::ssize(state.list) == inside_->options.offspring + 1;
  for (const Kept& kept : state.list) same = same && std::ssize(kept.x) == task().parameters.size();
  expect_same_search(same, file);
  std::istringstream algorithm(state.algorithm);
  boost::archive::text_iarchive(algorithm) >> inside_->algorithm;
  for (std::size_t k = 1; k < state.list.size(); ++k)
    inside_->population.set_xf(k - 1, state.list[k].x, {state.list[k].error_rad});
  found(vector(state.list.front().x), state.list.front().error_rad);
  inside_->generation = state.generation;
}

}  // namespace sim::calibration
