#pragma once
#include <optional>
#include <string>
#include <vector>

#include "sim/gap/diagnosis/answer.hpp"
#include "sim/gap/diagnosis/attribution.hpp"
#include "sim/gap/diagnosis/problem.hpp"
#include "sim/gap/estimation/as_built.hpp"

/// What sim/gap/estimation finds, as an answer: effects that are missing, constants beyond their tolerances, and
/// constants within them.
namespace sim::diagnosis {

/// A constant of robot.xml as the recordings have it.
struct ConstantEstimate {
  std::string name, on;
  effects::Stage stage;
  double nominal = 0, tolerance = 0;  ///< tolerance: one standard deviation
  double value = 0;
  Interval interval;      ///< 95 %
  double determined = 0;  ///< 1: by the recordings alone, 0: by its tolerance alone
  bool beyond =
      false;  ///< far off, or a zero that is off beside exact constants (sim/gap/estimation)

  /// Whether it certainly differs from its nominal value: by more than three standard deviations.
  bool differs() const;
};

struct JointEstimate {
  erp::Robot robot;
  std::vector<ConstantEstimate> constants;  ///< in the order of the chain
  std::vector<IdentifiedEffect> answer;     ///< effects, then constants beyond their tolerances
  Evaluator evaluator;                      ///< of `robot`
  std::vector<StageGap> left;               ///< on the recordings held out; open: not explained
  bool exact = false;        ///< constants are as described, but for zeros and the like
  bool unknown_law = false;  ///< one law that the library lacks is likelier than any answer
  bool at_bound = false;     ///< a parameter of an effect ends at a bound
  double interaction = 0;    ///< of the causes of the answer (shares.hpp)
  std::vector<Attribution>
      off;  ///< where its constants are off, by what each part changes in the residuals

  bool explained() const;
};

/// `robot`: with what was seen without a fit. `suggested`: effects that a search with constants as they are
/// described has found.
JointEstimate estimate_jointly(const Problem& problem, const erp::Robot& robot,
                               const Evaluator& plain,
                               const std::vector<IdentifiedEffect>& suggested);

/// The one effect of an answer on `robot`, as described but for zeros and the like, by the estimate of sim/gap/estimation: without
/// gain and alternatives.
IdentifiedEffect estimated(const Problem& problem, const erp::Robot& robot,
                           const IdentifiedEffect& effect);

}  // namespace sim::diagnosis
