#pragma once
#include "sim/gap/estimation/far_off.hpp"
#include "sim/gap/estimation/search.hpp"

/// A robot as it was built: every constant a little off its description, some beyond what building
/// allows, and effects that the description lacks.
namespace sim::estimation {

struct AsBuilt {
  Uncertain uncertain;
  Estimate estimate;
  /// Constants off by more than their tolerances, the farthest first.
  std::vector<std::size_t> beyond;
  std::vector<std::vector<Sized>> instead;            ///< of each: alternatives
  erp::Robot robot;                                   ///< nominal with all that was found
  std::vector<std::vector<Sized>> indistinguishable;  ///< of each effect: what could stand for it
  double cost = 0;                                    ///< search.hpp
  bool keeps = false;                                 ///< a stage keeps more than noise
  /// One law that the library lacks, at the only stage with a gap, has more evidence than several constants and
  /// effects: none is claimed, and `robot` is as described but for what is never certain.
  bool unknown_law = false;
  bool exact = false;  ///< no constant differs from robot.xml but those that are never certain
};

struct AsBuiltOptions {
  EstimateOptions estimate;
  SearchOptions search;
  std::vector<effects::Placed> suggested = {};  ///< an answer found otherwise
};

/// Constants estimated on `train`, effects judged on `held_out`. Throws as residuals::Stages.
AsBuilt as_built(const erp::Robot& nominal, std::span<const residuals::Episode> train,
                 std::span<const residuals::Episode> held_out, const AsBuiltOptions& options = {});

/// The constants alone: no effect is looked for.
AsBuilt calibrated(const erp::Robot& nominal, std::span<const residuals::Episode> train,
                   const EstimateOptions& options = {});

/// One effect on a robot that is as described but for what is never certain: no other is looked for.
Sized estimated(const erp::Robot& nominal, std::span<const residuals::Episode> train,
                const effects::Placed& effect, const EstimateOptions& options = {});

/// A constant is determined if less than 0.63 of its tolerance is left; chosen.
inline constexpr double well_determined = 0.6;

/// How well a constant is determined: 1 − (its deviation after/before)², 0: not at all.
double determined(const AsBuilt& built, std::size_t constant);

}  // namespace sim::estimation
