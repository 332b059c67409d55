#pragma once
#include <optional>
#include <string>
#include <vector>

#include "sim/gap/diagnosis/evaluation.hpp"
#include "sim/gap/diagnosis/split.hpp"

/// Dependence of a residual on one measured variable, without a law: mean residual in bins of the
/// variable.
///
///   m(x) = mean of r over the training windows whose variable is in the bin of x
///   explained = (Σ r² − Σ (r − m)²)/(Σ r² − n)     on the n held-out windows; r in units of noise
namespace sim::diagnosis {

/// A variable that a residual may depend on.
struct Variable {
  std::string name, unit;
  std::vector<double> value;  ///< by window
};
/// Returns the variables of a stage of an actuator or joint in one recording.
std::vector<Variable> variables(const Evaluator& evaluator, std::size_t episode,
                                effects::Stage stage, const std::string& on);

struct ResidualProfile {
  std::string variable, unit;
  std::vector<double> middle;           ///< centre of each bin
  std::vector<double> mean, deviation;  ///< of the residual in each bin
  double explained = 0;                 ///< at most 1
  double constant = 0;  ///< part of `explained` that the mean of the training windows explains
};

/// Returns the profile that explains most of the residual of a stage. Empty if no variable was
/// measured.
std::optional<ResidualProfile> residual_profile(const Evaluator& evaluator,
                                                const Evaluation& evaluation, effects::Stage stage,
                                                const std::string& on,
                                                std::span<const std::size_t> train,
                                                std::span<const std::size_t> held_out);

/// Returns the largest part of a stage's residual above noise that a function of one variable
/// explains better than a constant. Variables: angles, speeds, tensions …, but not time. 0 if the
/// held-out recordings are the training recordings.
double explained_by_one_variable(const Evaluator& evaluator, const Evaluation& evaluation,
                                 effects::Stage stage, const std::string& on, const Sets& sets);

/// A concentration of the residual: fraction of Σ r² in one fifth of the windows, sorted by a
/// variable.
struct Region {
  std::string variable;
  std::string fifth;  ///< "lowest", "low", "middle", "high", "highest"
  double share = 0;   ///< of Σ r²; 0.2: uniform
};
/// Returns the regions with a share above 0.35, the largest first.
std::vector<Region> regions(const Evaluator& evaluator, const Evaluation& evaluation,
                            effects::Stage stage, const std::string& on,
                            std::span<const std::size_t> episodes);

}  // namespace sim::diagnosis
