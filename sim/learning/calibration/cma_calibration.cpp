#include "sim/learning/calibration/cma_calibration.hpp"

#include <pagmo/algorithm.hpp>
#include <pagmo/algorithms/cmaes.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>
#include <pagmo/s11n.hpp>
#include <sstream>

#include "sim/learning/calibration/saved_point.hpp"

namespace sim::calibration {
namespace {

using pagmo::vector_double;

/// pagmo's problem interface. It holds a pointer to the task of the CmaCalibration that owns the
/// population.
struct Problem {
  const Task* task = nullptr;
  double bound = 0;

  vector_double fitness(const vector_double& x) const { return {error_rad(*task, vector(x))}; }
  std::pair<vector_double, vector_double> get_bounds() const {
    const auto size = task ? static_cast<std::size_t>(task->parameters.size()) : 1;
    return {vector_double(size, -bound), vector_double(size, bound)};
  }
  template <class Archive>
  void serialize(Archive&, unsigned) {}  // populations are not saved, only their points
};

/// `list` holds the best candidate so far, then the population.
struct CmaState {
  static constexpr auto element = "cma";
  xml::Place place;
  int generation = 0;
  std::string seed, algorithm;  ///< pagmo's serialized algorithm
  std::vector<SavedPoint> list;
  void visit(auto& v) {
    v.required("generation", generation);
    v.required("seed", seed);
    v.required("algorithm", algorithm);
    v.list(list);
  }
};

pagmo::algorithm algorithm_of(const EvolutionOptions& o) {
  const double first_sigma =
      o.first_sigma / (2 * o.bound);           // pagmo's unit: the distance of the bounds
  constexpr double automatic = -1, never = 0;  // pagmo's default rates; no stopping criterion
  return pagmo::algorithm(
      pagmo::cmaes(1, automatic, automatic, automatic, automatic, first_sigma, never, never,
                   /*memory=*/true, /*force_bounds=*/true, static_cast<unsigned>(o.seed)));
}

}  // namespace

struct CmaCalibration::Impl {
  EvolutionOptions options;
  pagmo::algorithm algorithm;
  pagmo::population population;
  int generation = 0;
};

CmaCalibration::CmaCalibration(Task task, const EvolutionOptions& options)
    : Calibration(std::move(task)),
      impl_(new Impl{options, algorithm_of(options),
                     pagmo::population(Problem{&this->task(), options.bound}, 0u, 0u)}) {
  for (int k = 0; k < options.offspring; ++k)
    impl_->population.push_back(numbers(best()), {best_error_rad()});
}
CmaCalibration::~CmaCalibration() = default;

void CmaCalibration::round(const Pool&) {
  impl_->population = impl_->algorithm.evolve(impl_->population);
  ++impl_->generation;
  const auto& population = impl_->population;
  const auto first = population.best_idx();
  update_best(vector(population.get_x()[first]), population.get_f()[first].front());
}

int CmaCalibration::rounds() const { return impl_->generation; }

long CmaCalibration::evaluated_poses() const {
  return std::ssize(task().poses.learn) * impl_->options.offspring * rounds();
}

std::string CmaCalibration::state() const {
  std::ostringstream algorithm;
  boost::archive::text_oarchive(algorithm) << impl_->algorithm;
  CmaState state{{}, rounds(), std::to_string(impl_->options.seed), algorithm.str(), {}};
  state.list.push_back({{}, numbers(best()), {}, best_error_rad()});
  const auto& population = impl_->population;
  for (std::size_t k = 0; k < population.size(); ++k)
    state.list.push_back({{}, population.get_x()[k], {}, population.get_f()[k].front()});
  return xml::write(state);
}

void CmaCalibration::restore(const std::string& text, const std::string& file) {
  const auto state = xml::parse<CmaState>(text, file);
  bool is_same_search = state.seed == std::to_string(impl_->options.seed) &&
                        std::ssize(state.list) == impl_->options.offspring + 1;
  for (const SavedPoint& saved : state.list)
    is_same_search = is_same_search && std::ssize(saved.x) == task().parameters.size();
  expect_same_search(is_same_search, file);
  std::istringstream algorithm(state.algorithm);
  boost::archive::text_iarchive(algorithm) >> impl_->algorithm;
  for (std::size_t k = 1; k < state.list.size(); ++k)
    impl_->population.set_xf(k - 1, state.list[k].x, {state.list[k].error_rad});
  update_best(vector(state.list.front().x), state.list.front().error_rad);
  impl_->generation = state.generation;
}

}  // namespace sim::calibration
