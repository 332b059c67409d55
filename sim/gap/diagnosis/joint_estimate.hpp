#pragma once
#include <optional>
#include <string>
#include <vector>

#include "sim/gap/diagnosis/answer.hpp"
#include "sim/gap/diagnosis/attribution.hpp"
#include "sim/gap/diagnosis/problem.hpp"
#include "sim/gap/estimation/as_built.hpp"

/// The result of sim/gap/estimation as an answer: missing effects, constants beyond their tolerances, and
/// constants within them.
namespace sim::diagnosis {

/// A constant of robot.xml as estimated.
struct ConstantEstimate {
  std::string name, on;
  effects::Stage stage;
  double nominal = 0, tolerance = 0;  ///< tolerance: one standard deviation
  double value = 0;
  Interval interval;      ///< 95 %
  double determined = 0;  ///< 1: by the recordings alone, 0: by its tolerance alone
  bool beyond = false;    ///< its tolerance, or a zero with an error while constants are exact

  /// Whether it differs from its nominal value by more than three standard deviations.
  bool differs() const;
};

struct JointEstimate {
  erp::Robot robot;
  std::vector<ConstantEstimate> constants;  ///< in the order of the chain
  std::vector<IdentifiedEffect> answer;     ///< effects, then constants beyond their tolerances
  Evaluator evaluator;                      ///< of `robot`
  std::vector<StageGap> left;  ///< remaining residual, held-out recordings; open: unexplained
  bool exact = false;          ///< constants are as described, except unmeasured zeros
  bool unknown_law = false;    ///< one law outside the library is likelier than any answer
  bool at_bound = false;       ///< a parameter of an effect is at a bound
  double interaction = 0;      ///< of the causes of the answer (shapley.hpp)
  std::vector<Attribution>
      off;  ///< parts with deviating constants, by their change of the residuals

  bool explained() const;
};

/// `robot`: with directly detected effects. `suggested`: effects found by a search with constants as
/// described.
JointEstimate estimate_jointly(const Problem& problem, const erp::Robot& robot,
                               const Evaluator& plain,
                               const std::vector<IdentifiedEffect>& suggested);

/// `effect` with values and intervals estimated together with the unmeasured zeros of `robot`, other
/// constants as described. Gain and alternatives are not set.
IdentifiedEffect estimated(const Problem& problem, const erp::Robot& robot,
                           const IdentifiedEffect& effect);

}  // namespace sim::diagnosis
