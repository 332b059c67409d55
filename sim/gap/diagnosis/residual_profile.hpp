#pragma once
#include <optional>
#include <string>
#include <vector>

#include "sim/gap/diagnosis/evaluation.hpp"
#include "sim/gap/diagnosis/split.hpp"

/// On what a residual depends, without a law: a map of bins over one variable.
///
///   m(x) = mean of r over the training windows whose variable falls into x's bin
///   explained = (Σ r² − Σ (r − m)²)/(Σ r² − n)            on the held-out windows, n: the noise
namespace sim::diagnosis {

/// What a window looks like: the variables that a residual may depend on.
struct Variable {
  std::string name, unit;
  std::vector<double> value;  ///< one a window
};
/// Of a stage of an actuator or joint, in one recording.
std::vector<Variable> variables(const Evaluator& evaluator, std::size_t episode,
                                effects::Stage stage, const std::string& on);

struct ResidualProfile {
  std::string variable, unit;
  std::vector<double> middle, mean, deviation;  ///< by bin: where, residual, its spread
  double explained = 0;                         ///< 1 at most
  double constant = 0;  ///< of that, what the mean of the training windows explains alone
};

/// The map that explains most of what `trial` leaves at a stage; nothing if no variable was
/// measured.
std::optional<ResidualProfile> residual_profile(const Evaluator& evaluator,
                                                const Evaluation& evaluation, effects::Stage stage,
                                                const std::string& on,
                                                std::span<const std::size_t> train,
                                                std::span<const std::size_t> held_out);

/// How much of what `trial` leaves at a stage, noise aside, is a function of one variable: of angles,
/// speeds, tensions …, not of the time. What a constant explains does not count, and where the
/// windows that teach are those that judge nothing does.
double follows(const Evaluator& evaluator, const Evaluation& evaluation, effects::Stage stage,
               const std::string& on, const Sets& sets);

/// Where a residual lives: of each variable, how much of Σ r² falls into which fifth of its
/// windows.
struct Region {
  std::string variable;
  std::string fifth;  ///< "lowest", "low", "middle", "high", "highest"
  double share = 0;   ///< of Σ r², 0.2: as everywhere
};
/// The regions that hold more than their part, the most crowded first.
std::vector<Region> regions(const Evaluator& evaluator, const Evaluation& evaluation,
                            effects::Stage stage, const std::string& on,
                            std::span<const std::size_t> episodes);

}  // namespace sim::diagnosis
