#include "sim/learning/calibration/evolution.hpp"

#include <algorithm>
#include <cmath>

#include "sim/learning/training_loop/random_stream.hpp"

namespace sim::calibration {
namespace {

/// x reflected at ± bound until it lies inside.
double reflected(double x, double bound) {
  const double period = 4 * bound, t = std::fmod(std::fmod(x + bound, period) + period, period);
  return (t <= 2 * bound ? t : period - t) - bound;
}

}  // namespace

Evolution::Evolution(const Eigen::VectorXd& first, const EvolutionOptions& options)
    : Evolution(std::vector<Individual>(
                    static_cast<std::size_t>(options.parents),
                    {first, Eigen::VectorXd::Constant(first.size(), options.first_sigma)}),
                0, options) {}

Evolution::Evolution(std::vector<Individual> parents, int generation,
                     const EvolutionOptions& options)
    : options_(options), parents_(std::move(parents)), generation_(generation) {}

std::vector<Individual> Evolution::offspring() const {
  std::vector<Individual> all;
  for (int k = 0; k < options_.offspring; ++k)
    all.push_back(mutated(static_cast<std::uint64_t>(k)));
  return all;
}

Individual Evolution::mutated(std::uint64_t number) const {
  auto random =
      training_loop::random_stream(options_.seed, static_cast<std::uint64_t>(generation_), number);
  std::normal_distribution<double> normal;
  std::uniform_int_distribution<std::size_t> any_parent(0, parents_.size() - 1);
  const Individual &parent = parents_[any_parent(random)], &other = parents_[any_parent(random)];
  Individual child{(parent.x + other.x) / 2, parent.sigma};
  const double n = static_cast<double>(child.x.size());
  const double individual_rate = 1 / std::sqrt(2 * std::sqrt(n)),
               common_factor = normal(random) / std::sqrt(2 * n);
  for (Eigen::Index i = 0; i < child.x.size(); ++i) {
    child.sigma[i] = std::sqrt(parent.sigma[i] * other.sigma[i]);
    child.sigma[i] *= std::exp(common_factor + individual_rate * normal(random));
    child.x[i] = reflected(child.x[i] + child.sigma[i] * normal(random), options_.bound);
  }
  return child;
}

void Evolution::select(std::vector<Individual> evaluated) {
  std::ranges::stable_sort(evaluated, {}, &Individual::error);
  evaluated.resize(parents_.size());
  parents_ = std::move(evaluated);
  ++generation_;
}

}  // namespace sim::calibration
