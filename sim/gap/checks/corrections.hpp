#pragma once
#include <vector>

#include "sim/gap/checks/laws.hpp"

/// Finds the wrong columns of a recording that violates the robot's laws. Every sign, unit and
/// exchange of columns is tested. The correction with the highest score is reported:
///
///   score = number of repaired laws − number of laws that become violated
///
/// Thus one column of wrong sign is reported once, not once for each law that it violates.
namespace sim::checks {

struct Correction {
  enum class Kind { scaled, exchanged, contradicting } kind;
  /// Scaled: one column. Exchanged: the first half with the second half. Contradicting: all columns
  /// of the law.
  std::vector<Column> columns;
  double factor = 1;             ///< of a scaled column: recorded value / correct value
  const char* remedy = "";       ///< the probable unit and the remedy; empty: no known unit
  std::vector<Column> evidence;  ///< the other columns of the repaired laws
};

/// Corrections of the same score.
using Alternatives = std::vector<Correction>;

/// Finds and applies one correction after another until no law is suspicious or no correction
/// helps. At most eight. A contradiction without a correction is the last element.
std::vector<Alternatives> corrections(const erp::Robot& robot, Laws& laws, Means means);

}  // namespace sim::checks
