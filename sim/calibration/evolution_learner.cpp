#include "sim/calibration/evolution_learner.hpp"

#include <limits>
#include <numbers>
#include <stdexcept>

#include "interfaces/xml/xml.hpp"
#include "sim/parallel/in_parallel.hpp"

namespace sim::calibration {
namespace {

/// An individual in state.xml.
struct Kept {
  static constexpr auto element = "individual";
  xml::Place place;
  std::vector<double> x, sigma;
  double error_rad = 0;
  void visit(auto& v) {
    v.required("x", x);
    v.required("sigma", sigma);
    v.required("error_rad", error_rad);
  }
};

/// The best so far comes first, then the parents.
struct State {
  static constexpr auto element = "evolution";
  xml::Place place;
  int generation = 0;
  std::string seed;
  std::vector<Kept> list;
  void visit(auto& v) {
    v.required("generation", generation);
    v.required("seed", seed);
    v.list(list);
  }
};

std::vector<double> numbers(const Eigen::VectorXd& x) { return {x.begin(), x.end()}; }
Eigen::VectorXd vector(const std::vector<double>& x) {
  return Eigen::Map<const Eigen::VectorXd>(x.data(), std::ssize(x));
}

Kept kept(const Individual& one) { return {{}, numbers(one.x), numbers(one.sigma), one.error}; }
Individual taken(const Kept& one) { return {vector(one.x), vector(one.sigma), one.error_rad}; }

}  // namespace

EvolutionLearner::EvolutionLearner(Parameters parameters, PoseSet poses,
                                   const EvolutionOptions& options)
    : parameters_(std::move(parameters)),
      poses_(std::move(poses)),
      options_(options),
      evolution_(Eigen::VectorXd::Zero(parameters_.size()), options),
      best_(evolution_.parents().front()) {
  best_.error = pose_errors(parameters_.at(best_.x), poses_.learn).mean_of_all_rad;
}

/// What cannot stand, such as a point inside its pulley, is worse than all that can.
void EvolutionLearner::judge(Individual& individual) const {
  try {
    individual.error = pose_errors(parameters_.at(individual.x), poses_.learn).mean_of_all_rad;
  } catch (const std::invalid_argument&) {
    individual.error = std::numeric_limits<double>::max();
  }
}

void EvolutionLearner::round(int threads) {
  auto offspring = evolution_.offspring();
  in_parallel(offspring.size(), threads, [&](std::size_t k) { judge(offspring[k]); });
  evolution_.select(std::move(offspring));
  if (const Individual& first = evolution_.parents().front(); first.error < best_.error)
    best_ = first;
}

std::vector<learner::Metric> EvolutionLearner::metrics() const {
  constexpr double degree = std::numbers::pi / 180;
  std::vector<learner::Metric> all;
  const Candidate candidate = parameters_.at(best_.x);
  const auto add = [&](const char* of, std::span<const StillPose> poses) {
    if (poses.empty()) return;
    const PoseErrors errors = pose_errors(candidate, poses);
    std::size_t k = 0;
    for (const erp::Joint& joint : candidate.robot.joints())
      if (coordinates_of(joint.type) > 0)
        all.push_back({joint.name + of, errors.mean_rad[k++] / degree});
  };
  add(".learnt_deg", poses_.learn), add(".checked_deg", poses_.check);
  return all;
}

std::string EvolutionLearner::state() const {
  State state{{}, evolution_.generation(), std::to_string(options_.seed), {kept(best_)}};
  for (const Individual& parent : evolution_.parents()) state.list.push_back(kept(parent));
  return xml::write(state);
}

void EvolutionLearner::restore(const std::string& text, const std::string& file) {
  const auto state = xml::parse<State>(text, file);
  bool fits =
      state.seed == std::to_string(options_.seed) && std::ssize(state.list) == options_.parents + 1;
  for (const Kept& one : state.list)
    fits = fits && std::ssize(one.x) == parameters_.size() && one.sigma.size() == one.x.size();
  if (!fits)
    throw std::invalid_argument(file + ": of another seed, population or choice of parameters");
  best_ = taken(state.list.front());
  std::vector<Individual> parents;
  for (std::size_t k = 1; k < state.list.size(); ++k) parents.push_back(taken(state.list[k]));
  evolution_ = Evolution(std::move(parents), state.generation, options_);
}

}  // namespace sim::calibration
