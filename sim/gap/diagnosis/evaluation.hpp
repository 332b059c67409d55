#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "sim/gap/residuals/noise_floor.hpp"

/// A robot with effects, tried on recordings: its residuals in units of their noise.
///
///   z = r/σ     r residual of a stage at a window, σ its noise floor there
///   S = Σ z²    over stages and windows that the nominal robot can judge
///
/// Where a trial cannot judge a window that the nominal robot can, the nominal residual stays: to
/// look away explains nothing.
namespace sim::diagnosis {

/// The residuals of one trial on every recording.
struct Evaluation {
  std::vector<effects::Placed> effects;
  std::vector<residuals::Explanation> of_episode;
};

/// Sums over about a second of one recording: what the bootstrap draws.
struct ScoreBlock {
  double square = 0;  ///< Σ z²
  std::size_t windows = 0;
};

class Evaluator {
 public:
  /// Throws as Stages; std::invalid_argument when no stage is to be had from the recordings.
  Evaluator(const erp::Robot& nominal, std::vector<residuals::Episode> episodes,
            std::uint64_t seed = 1);

  std::span<const residuals::Episode> episodes() const { return episodes_; }
  const erp::Robot& nominal() const { return nominal_; }
  /// The robot as it is given.
  const Evaluation& bare() const { return bare_; }

  /// The robot with those effects of `base` and one more, on some recordings; the others stay
  /// empty.
  Evaluation with(const Evaluation& base, const effects::Placed& more,
                  std::span<const std::size_t> episodes) const;
  Evaluation with(std::span<const effects::Placed> all,
                  std::span<const std::size_t> episodes) const;
  /// The same effects as those of `base`, on the same recordings, but that number k has other
  /// values.
  Evaluation changed(const Evaluation& base, std::size_t k, const effects::Placed& other,
                     std::span<const std::size_t> episodes) const;

  /// z of one recording: stages one after the other, NaN where the nominal robot cannot judge.
  std::vector<double> whitened(const Evaluation& evaluation, std::size_t episode) const;
  /// Scores of the stages for which `counts`, or of all.
  std::vector<ScoreBlock> blocks(const Evaluation& evaluation,
                                 std::span<const std::size_t> episodes,
                                 const std::function<bool(const residuals::Residual&)>& counts = {},
                                 double block_s = 1) const;
  /// σ of each residual of an episode, rms over its windows.
  double floor(std::size_t episode, std::size_t residual) const {
    return floors_[episode][residual].rms;
  }
  /// The same under a trial: where an effect is undone, some noise comes back that it had smoothed.
  /// In the order of the trial's residuals; costs two explanations of the recording.
  std::vector<residuals::Floor> floor_under(const Evaluation& evaluation,
                                            std::size_t episode) const;

  /// nominal() with these effects beside its own.
  erp::Robot robot_with(std::span<const effects::Placed> all) const;

 private:
  /// All those effects, of which only one differs from what `base` has.
  Evaluation beside(const Evaluation& base, std::vector<effects::Placed> all,
                    const effects::Placed& differs, std::span<const std::size_t> episodes) const;

  erp::Robot nominal_;
  std::vector<residuals::Episode> episodes_;
  std::uint64_t seed_;
  Evaluation bare_;
  std::vector<std::vector<residuals::Floor>> floors_;
};

/// Σ over blocks.
ScoreBlock sum(std::span<const ScoreBlock> blocks);

}  // namespace sim::diagnosis
