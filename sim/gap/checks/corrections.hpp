#pragma once
#include <vector>

#include "sim/gap/checks/laws.hpp"

/// What may be wrong with the columns of a recording whose laws are odd, by a vote: each sign, unit
/// and exchange of channels is tried, and what puts most laws right, less those that it spoils, is
/// told. So one turned column is told once, and not as many as it contradicts.
namespace sim::checks {

struct Correction {
  enum class Kind { scaled, exchanged, contradicting } kind;
  std::vector<Column> columns;  ///< one; or one half, then with whom each was exchanged; or a law's
  double times = 1;             ///< of a scaled one: as large as it should be
  const char* like = "";        ///< the unit it looks like and what to do; empty: none known
  std::vector<Column> evidence;  ///< the other columns of the laws that it puts right
};

/// Mendings that would do equally well.
using Either = std::vector<Correction>;

/// One after another until no law is odd; what is left contradicting last.
std::vector<Either> corrections(const erp::Robot& robot, Laws& laws, Means means);

}  // namespace sim::checks
