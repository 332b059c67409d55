#include "sim/learning/calibration/evolution_calibration.hpp"

#include "sim/learning/calibration/saved_point.hpp"

namespace sim::calibration {
namespace {

/// `list` holds the best candidate so far, then the parents.
struct State {
  static constexpr auto element = "evolution";
  xml::Place place;
  int generation = 0;
  std::string seed;
  std::vector<SavedPoint> list;
  void visit(auto& v) {
    v.required("generation", generation);
    v.required("seed", seed);
    v.list(list);
  }
};

}  // namespace

EvolutionCalibration::EvolutionCalibration(Task task, const EvolutionOptions& options)
    : Calibration(std::move(task)), options_(options), evolution_(best(), options) {}

void EvolutionCalibration::round(const Pool& pool) {
  auto offspring = evolution_.offspring();
  const auto errors = pool.map(offspring.size(), [&](std::size_t k) {
    return Pool::Numbers{error_rad(task(), offspring[k].x)};
  });
  for (std::size_t k = 0; k < offspring.size(); ++k) offspring[k].error = errors[k].front();
  evolution_.select(std::move(offspring));
  update_best(evolution_.parents().front().x, evolution_.parents().front().error);
}

long EvolutionCalibration::evaluated_poses() const {
  return std::ssize(task().poses.learn) * options_.offspring * rounds();
}

std::string EvolutionCalibration::state() const {
  State state{{}, rounds(), std::to_string(options_.seed), {}};
  state.list.push_back({{}, numbers(best()), {}, best_error_rad()});
  for (const Individual& parent : evolution_.parents())
    state.list.push_back({{}, numbers(parent.x), numbers(parent.sigma), parent.error});
  return xml::write(state);
}

void EvolutionCalibration::restore(const std::string& text, const std::string& file) {
  const auto state = xml::parse<State>(text, file);
  bool is_same_search =
      state.seed == std::to_string(options_.seed) && std::ssize(state.list) == options_.parents + 1;
  for (std::size_t k = 0; k < state.list.size(); ++k)
    is_same_search = is_same_search && std::ssize(state.list[k].x) == task().parameters.size() &&
                     (k == 0 || state.list[k].sigma.size() == state.list[k].x.size());
  expect_same_search(is_same_search, file);
  std::vector<Individual> parents;
  for (std::size_t k = 1; k < state.list.size(); ++k) {
    const SavedPoint& saved = state.list[k];
    parents.push_back({vector(saved.x), vector(saved.sigma), saved.error_rad});
  }
  update_best(vector(state.list.front().x), state.list.front().error_rad);
  evolution_ = Evolution(std::move(parents), state.generation, options_);
}

}  // namespace sim::calibration
