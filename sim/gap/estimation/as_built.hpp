#pragma once
#include "sim/gap/estimation/far_off.hpp"
#include "sim/gap/estimation/search.hpp"

/// A robot as it was built: every constant deviates a little from its description, some by more than their tolerances,
/// and the description lacks effects.
namespace sim::estimation {

struct AsBuilt {
  Uncertain uncertain;
  Estimate estimate;
  /// Constants beyond their tolerances, the largest deviation first.
  std::vector<std::size_t> beyond;
  std::vector<std::vector<Sized>> instead;  ///< alternatives of each
  erp::Robot robot;                         ///< nominal, with the estimated constants and effects
  std::vector<std::vector<Sized>> indistinguishable;  ///< for each effect, what could replace it
  double cost = 0;                                    ///< search.hpp
  bool keeps = false;                                 ///< whether a stage keeps more than noise
  /// True if a law that the library lacks, at the only stage with a gap, has more evidence than several constants and
  /// effects. Then no cause is named, and `robot` is as described except for what is never certain.
  bool unknown_law = false;
  bool exact = false;  ///< only constants that are never certain differ from robot.xml
};

struct AsBuiltOptions {
  EstimateOptions estimate;
  SearchOptions search;
  std::vector<effects::Placed> suggested = {};  ///< an answer of another method
};

/// Constants estimated on `train`, effects judged on `held_out`. Throws as residuals::Stages.
AsBuilt as_built(const erp::Robot& nominal, std::span<const residuals::Episode> train,
                 std::span<const residuals::Episode> held_out, const AsBuiltOptions& options = {});

/// Estimates the constants alone, without effects.
AsBuilt calibrated(const erp::Robot& nominal, std::span<const residuals::Episode> train,
                   const EstimateOptions& options = {});

/// Estimates one effect on a robot that is as described except for what is never certain. No other effect is searched.
Sized estimated(const erp::Robot& nominal, std::span<const residuals::Episode> train,
                const effects::Placed& effect, const EstimateOptions& options = {});

/// Threshold of `determined`: the standard error is below 0.63 of the tolerance; chosen.
inline constexpr double well_determined = 0.6;

/// How well the recordings determine a constant: 1 − (standard error/tolerance)²; 0: not at all.
double determined(const AsBuilt& built, std::size_t constant);

}  // namespace sim::estimation
