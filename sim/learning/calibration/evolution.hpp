#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

/// (µ, λ) evolution strategy with one self-adapting step size per coordinate (Schwefel; Beyer and
/// Schwefel 2002, the paper's 4.4):
///
///   σ'_i = σ_i exp(τ' N(0,1) + τ N_i(0,1)),   x'_i = x_i + σ'_i N_i(0,1)
///   τ' = 1/√(2n),  τ = 1/√(2√n)
///
/// The parents of a generation are the µ best of the λ offspring of the previous generation.
/// Parents do not survive. An offspring's x is the mean of two parents', its σ their geometric mean
/// (intermediate recombination, Schwefel). Without it, step sizes would only decrease. Values
/// outside the bounds are reflected.
///
/// Each offspring has its own random stream, from seed, generation and number. The results
/// therefore do not depend on the number of threads.
namespace sim::calibration {

struct Individual {
  Eigen::VectorXd x, sigma;
  double error = 0;  ///< objective, to be minimised
};

struct EvolutionOptions {
  int parents = 6, offspring = 36;
  double first_sigma = 0.3;  ///< initial σ_i, in normalised coordinates; chosen
  double bound = 3;          ///< limit of |x_i|; chosen
  std::uint64_t seed = 1;
};

class Evolution {
 public:
  /// All parents start at `first`.
  Evolution(const Eigen::VectorXd& first, const EvolutionOptions& options = {});
  /// Continues from the parents selected after `generation` generations.
  Evolution(std::vector<Individual> parents, int generation, const EvolutionOptions& options = {});

  int generation() const { return generation_; }
  const std::vector<Individual>& parents() const { return parents_; }
  /// λ new individuals, not evaluated yet.
  std::vector<Individual> offspring() const;
  /// Makes the µ best of the evaluated offspring the parents. Equal errors keep their order.
  void select(std::vector<Individual> evaluated);

 private:
  Individual mutated(std::uint64_t number) const;

  EvolutionOptions options_;
  std::vector<Individual> parents_;
  int generation_ = 0;
};

}  // namespace sim::calibration
