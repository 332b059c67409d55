#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

/// (µ, λ) evolution strategy, every coordinate with a step size of its own that evolves with it
/// (Schwefel; Beyer and Schwefel 2002, the paper's 4.4):
///
///   σ'_i = σ_i exp(τ' N(0,1) + τ N_i(0,1)),   x'_i = x_i + σ'_i N_i(0,1)
///   τ' = 1/√(2n),  τ = 1/√(2√n)
///
/// The parents of each generation are the µ best of the λ offspring of the one before; none outlives
/// its generation. An offspring's x is the mean of two parents', its σ their geometric mean, or step
/// sizes would only fall (intermediate recombination, Schwefel). What falls outside the bounds is
/// reflected.
///
/// Each offspring's dice are its own, of seed, generation and number: the same on any threads.
namespace sim::calibration {

struct Individual {
  Eigen::VectorXd x, sigma;
  double error = 0;  ///< what is to be small
};

struct EvolutionOptions {
  int parents = 6, offspring = 36;
  double first_sigma = 0.3;  ///< of normalised coordinates; chosen
  double bound = 3;          ///< |x_i| at most; chosen
  std::uint64_t seed = 1;
};

class Evolution {
 public:
  /// Begins where all parents are at `first`.
  Evolution(const Eigen::VectorXd& first, const EvolutionOptions& options = {});
  /// Goes on from the parents that have been chosen after so many generations.
  Evolution(std::vector<Individual> parents, int generation, const EvolutionOptions& options = {});

  int generation() const { return generation_; }
  const std::vector<Individual>& parents() const { return parents_; }
  /// λ of them, not judged yet.
  std::vector<Individual> offspring() const;
  /// Their errors are known: the best become parents. Ties: the first.
  void select(std::vector<Individual> judged);

 private:
  Individual mutated(std::uint64_t number) const;

  EvolutionOptions options_;
  std::vector<Individual> parents_;
  int generation_ = 0;
};

}  // namespace sim::calibration
