#pragma once
#include <optional>
#include <string>
#include <vector>

#include "sim/gap/diagnosis/answer.hpp"
#include "sim/gap/diagnosis/attribution.hpp"
#include "sim/gap/diagnosis/problem.hpp"
#include "sim/gap/estimation/as_built.hpp"

/// The result of sim/gap/estimation as an answer: missing effects, constants beyond their
/// tolerances, and constants within their tolerances.
namespace sim::diagnosis {

/// The estimate of a constant of robot.xml.
struct ConstantEstimate {
  std::string name, on;
  effects::Stage stage;
  double nominal = 0, tolerance = 0;  ///< tolerance: one standard deviation
  double value = 0;
  Interval interval;      ///< 95 %
  double determined = 0;  ///< 1: by the recordings only, 0: by its tolerance only
  bool beyond = false;  ///< beyond its tolerance; of a zero: has an error while constants are exact

  /// Whether it differs from its nominal value by more than three standard deviations.
  bool differs() const;
};

struct JointEstimate {
  erp::Robot robot;
  std::vector<ConstantEstimate> constants;  ///< by actuator, joint and body
  std::vector<IdentifiedEffect> answer;     ///< effects, then constants beyond their tolerances
  Evaluator evaluator;                      ///< of `robot`
  std::vector<StageGap>
      remaining;             ///< remaining residual of held-out recordings; open: unexplained
  bool exact = false;        ///< constants are as described, except unmeasured zeros
  bool unknown_law = false;  ///< a law outside the library has more evidence than any answer
  bool at_bound = false;     ///< a parameter of an effect is at a bound
  double interaction = 0;    ///< of the causes of the answer (shapley.hpp)
  std::vector<Attribution> deviating_parts;  ///< by the change of the residuals by their constants

  bool explained() const;
};

/// Estimates effects and constants jointly. `robot`: with directly detected effects. `suggested`:
/// effects that a search with constants as described found.
JointEstimate estimate_jointly(const Problem& problem, const erp::Robot& robot,
                               const Evaluator& baseline,
                               const std::vector<IdentifiedEffect>& suggested);

/// Estimates values and intervals of `effect` jointly with the unmeasured zeros of `robot`, with
/// other constants as described. Gain and alternatives are not set.
IdentifiedEffect estimated(const Problem& problem, const erp::Robot& robot,
                           const IdentifiedEffect& effect);

}  // namespace sim::diagnosis
