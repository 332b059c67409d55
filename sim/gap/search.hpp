#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "sim/gap/estimate.hpp"

/// Which effects of the library a robot has beside constants that differ: screened by what each could
/// explain that the constants and the effects found so far cannot, then estimated together with them.
///
///   score = gᵀ G⁻¹ g      g = Dᵀ W z,  G = Dᵀ W D − (Jᵀ W D)ᵀ H⁻¹ (Jᵀ W D)
///
/// D: what the effect's parameters change in z, J and H: of everything that is estimated already
/// (orthogonal least squares: Chen, Billings, Luo 1989). All stages and recordings take part, each
/// stage weighed by what it keeps. Parameters that shape a law (speeds, time constants, periods) are
/// scanned.
namespace sim::gap {

struct SearchOptions {
  std::vector<std::string> withhold;  ///< types of effects
  std::size_t most_effects = 3;
  std::size_t estimated = 8;  ///< candidates that pass the screen
  std::function<void(const std::string&, double)> progress = {};
};

struct Candidate {
  effects::Placed start;  ///< with the values that would explain most
  double score = 0;
};

/// An estimate with effects, and what it leaves of the recordings held out.
struct Found {
  Estimate train;
  Explained held_out;
  Eigen::VectorXd z_held_out;
};

struct Directions;

class Search {
 public:
  Search(const Estimator& train, const ResidualVector& held_out, const Uncertain& uncertain,
         const SearchOptions& options);

  /// Best first; at most one a type and place.
  std::vector<Candidate> screen(const Estimate& base) const;
  /// Adds effects to `base` while a stage is left with more than noise and one helps.
  Found run(Estimate base) const;
  Found judge(Estimate estimate) const;

 private:
  Candidate screen(const Estimate& base, const effects::Placed& neutral) const;
  std::optional<Found> best_beside(const Found& base) const;
  Found exchanged(Found found) const;
  Candidate screen(const Estimate& base, const Directions& directions) const;
  double profile(const Estimate& base, const Eigen::VectorXd& z) const;
  /// The same of the recordings held out, and the prior's share.
  double cost(const Found& found, const Estimate& base) const;
  void report(double share) const {
    if (options_.progress) options_.progress("effects", share);
  }

  const Estimator& train_;
  const ResidualVector& held_out_;
  const Uncertain& uncertain_;
  SearchOptions options_;
};

/// ⟨z²⟩ − 1 of each stage; 0: nothing but noise. A window counts for no more than six deviations of its
/// stage, so that one event does not pass for a law.
std::vector<double> excess(const ResidualVector& residuals, const Eigen::VectorXd& z);

}  // namespace sim::gap
