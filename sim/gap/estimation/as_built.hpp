#pragma once
#include "sim/gap/estimation/far_off.hpp"
#include "sim/gap/estimation/search.hpp"

/// A robot as it was built: every constant deviates a little from its description, some by more
/// than their tolerances, and the description lacks effects.
namespace sim::estimation {

struct AsBuilt {
  Uncertain uncertain;
  Estimate estimate;
  /// Indices of the constants beyond their tolerances, the largest deviation first.
  std::vector<std::size_t> beyond_tolerance;
  /// For each of them, the effects that could explain the same.
  std::vector<std::vector<SizedEffect>> alternatives;
  erp::Robot robot;  ///< nominal, with the estimated constants and effects
  /// For each effect, the effects that could replace it.
  std::vector<std::vector<SizedEffect>> indistinguishable;
  double cost = 0;              ///< search.hpp
  bool has_open_stage = false;  ///< search.hpp
  /// True if a law that the library lacks, at the only stage with a gap, has more evidence than
  /// several constants and effects. Then no cause is named, and `robot` is as described except for
  /// constants that are never certain.
  bool unknown_law = false;
  bool exact = false;  ///< only constants that are never certain differ from robot.xml
};

struct AsBuiltOptions {
  EstimateOptions estimate;
  SearchOptions search;
  std::vector<effects::Placed> suggested = {};  ///< an answer of another method
};

/// Estimates the constants on `train`, and judges effects also on `held_out`. Throws the exceptions
/// of residuals::Stages.
AsBuilt as_built(const erp::Robot& nominal, std::span<const residuals::Episode> train,
                 std::span<const residuals::Episode> held_out, const AsBuiltOptions& options = {});

/// Estimates the constants without effects.
AsBuilt calibrated(const erp::Robot& nominal, std::span<const residuals::Episode> train,
                   const EstimateOptions& options = {});

/// Estimates one effect on a robot that is as described except for constants that are never
/// certain. Other effects are not searched.
SizedEffect estimated(const erp::Robot& nominal, std::span<const residuals::Episode> train,
                      const effects::Placed& effect, const EstimateOptions& options = {});

/// Threshold of `determined` above which the recordings determine a constant: σ < 0.63 tolerance;
/// chosen.
inline constexpr double determined_threshold = 0.6;

/// How well the recordings determine a constant: 1 − (standard error/tolerance)²; 0: not at all.
double determined(const AsBuilt& built, std::size_t constant);

}  // namespace sim::estimation
