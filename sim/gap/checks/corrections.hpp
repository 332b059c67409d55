#pragma once
#include <vector>

#include "sim/gap/checks/laws.hpp"

/// Finds which columns of a recording are wrong if its laws are violated. Every sign, unit and exchange of channels is
/// tried. The correction with the highest score, laws repaired less laws broken, is reported. So one column of wrong
/// sign is reported once, not once for each law that it violates.
namespace sim::checks {

struct Correction {
  enum class Kind { scaled, exchanged, contradicting } kind;
  /// Scaled: the one column. Exchanged: the first half with the second half. Contradicting: all columns of the law.
  std::vector<Column> columns;
  double factor = 1;             ///< of a scaled column: recorded value / correct value
  const char* remedy = "";       ///< the probable unit and what to do; empty: no known unit
  std::vector<Column> evidence;  ///< the other columns of the laws that it repairs
};

/// Corrections of the same score.
using Alternatives = std::vector<Correction>;

/// One after another until no law is suspicious. A contradiction without a correction comes last.
std::vector<Alternatives> corrections(const erp::Robot& robot, Laws& laws, Means means);

}  // namespace sim::checks
