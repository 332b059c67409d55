#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "sim/gap/residuals/noise_floor.hpp"

/// Residuals of a robot with effects on recordings, in units of their noise.
///
///   z = r/σ     r: residual of a stage in a window, σ: its noise floor there
///   S = Σ z²    over stages and windows that can be evaluated for the nominal robot
///
/// If effects make a window impossible to evaluate, its nominal residual is kept: otherwise an effect
/// would gain by invalidating windows.
namespace sim::diagnosis {

/// Residuals of the robot with `effects` on every recording.
struct Evaluation {
  std::vector<effects::Placed> effects;
  std::vector<residuals::Explanation> of_episode;
};

/// Sums over about a second of one recording: the blocks that the bootstrap resamples.
struct ScoreBlock {
  double square = 0;  ///< Σ z²
  std::size_t windows = 0;
};

class Evaluator {
 public:
  /// Throws as Stages, and std::invalid_argument if no stage can be evaluated in the recordings.
  Evaluator(const erp::Robot& nominal, std::vector<residuals::Episode> episodes,
            std::uint64_t seed = 1);

  std::span<const residuals::Episode> episodes() const { return episodes_; }
  const erp::Robot& nominal() const { return nominal_; }
  /// Of the nominal robot without further effects.
  const Evaluation& bare() const { return bare_; }

  /// With the effects of `base` and one more, on `episodes`; other recordings stay empty.
  Evaluation with(const Evaluation& base, const effects::Placed& more,
                  std::span<const std::size_t> episodes) const;
  Evaluation with(std::span<const effects::Placed> all,
                  std::span<const std::size_t> episodes) const;
  /// With the effects of `base`, of which effect k is replaced by `other`.
  Evaluation changed(const Evaluation& base, std::size_t k, const effects::Placed& other,
                     std::span<const std::size_t> episodes) const;

  /// z of one recording, stage after stage; NaN where the nominal robot cannot be evaluated.
  std::vector<double> whitened(const Evaluation& evaluation, std::size_t episode) const;
  /// Scores of the stages for which `counts` is true, or of all stages.
  std::vector<ScoreBlock> blocks(const Evaluation& evaluation,
                                 std::span<const std::size_t> episodes,
                                 const std::function<bool(const residuals::Residual&)>& counts = {},
                                 double block_s = 1) const;
  /// σ of one residual of a recording, rms over its windows.
  double floor(std::size_t episode, std::size_t residual) const {
    return floors_[episode][residual].rms;
  }
  /// Noise floors of a robot with effects: compensating a low-pass amplifies noise. In the order of the
  /// residuals of `evaluation`; costs two evaluations of the recording.
  std::vector<residuals::Floor> floor_under(const Evaluation& evaluation,
                                            std::size_t episode) const;

  /// nominal() with these effects in addition to its own.
  erp::Robot robot_with(std::span<const effects::Placed> all) const;

 private:
  /// With `all`, of which only `differs` is not in `base`.
  Evaluation with_one_changed(const Evaluation& base, std::vector<effects::Placed> all,
                              const effects::Placed& differs,
                              std::span<const std::size_t> episodes) const;

  erp::Robot nominal_;
  std::vector<residuals::Episode> episodes_;
  std::uint64_t seed_;
  Evaluation bare_;
  std::vector<std::vector<residuals::Floor>> floors_;
};

/// Σ over blocks.
ScoreBlock sum(std::span<const ScoreBlock> blocks);

}  // namespace sim::diagnosis
