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
/// If a window cannot be evaluated with the effects, its nominal residual is used. Otherwise
/// effects would gain by invalidating windows.
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
  /// Throws the exceptions of Stages, and std::invalid_argument if no stage can be evaluated in the
  /// recordings.
  Evaluator(const erp::Robot& nominal, std::vector<residuals::Episode> episodes,
            std::uint64_t seed = 1);

  std::span<const residuals::Episode> episodes() const { return episodes_; }
  const erp::Robot& nominal() const { return nominal_; }
  /// The evaluation of the nominal robot without additional effects.
  const Evaluation& nominal_evaluation() const { return nominal_evaluation_; }

  /// Evaluates the effects of `base` and one more on `episodes`. Other recordings remain empty.
  Evaluation with(const Evaluation& base, const effects::Placed& added,
                  std::span<const std::size_t> episodes) const;
  Evaluation with(std::span<const effects::Placed> all,
                  std::span<const std::size_t> episodes) const;
  /// Evaluates the effects of `base` with effect k replaced by `other`.
  Evaluation changed(const Evaluation& base, std::size_t k, const effects::Placed& other,
                     std::span<const std::size_t> episodes) const;

  /// z of one recording, stage after stage; NaN where the nominal robot cannot be evaluated.
  std::vector<double> whitened(const Evaluation& evaluation, std::size_t episode) const;
  /// Scores of the stages for which `counts` is true, or of all stages.
  std::vector<ScoreBlock> blocks(const Evaluation& evaluation,
                                 std::span<const std::size_t> episodes,
                                 const std::function<bool(const residuals::Residual&)>& counts = {},
                                 double block_s = 1) const;
  /// Noise floor σ of one residual of a recording, rms over its windows.
  double floor(std::size_t episode, std::size_t residual) const {
    return floors_[episode][residual].rms;
  }
  /// Noise floors of the robot with effects, in the order of the residuals of `evaluation`. They
  /// differ because, for example, the compensation of a low-pass amplifies noise. Costs two
  /// evaluations of the recording.
  std::vector<residuals::Floor> floor_under(const Evaluation& evaluation,
                                            std::size_t episode) const;

  /// The nominal robot with additional effects.
  erp::Robot robot_with(std::span<const effects::Placed> all) const;

 private:
  /// Evaluates the effects `all`, of which only `differs` is not in `base`.
  Evaluation with_one_changed(const Evaluation& base, std::vector<effects::Placed> all,
                              const effects::Placed& differs,
                              std::span<const std::size_t> episodes) const;

  erp::Robot nominal_;
  std::vector<residuals::Episode> episodes_;
  std::uint64_t seed_;
  Evaluation nominal_evaluation_;
  std::vector<std::vector<residuals::Floor>> floors_;
};

/// Σ over blocks.
ScoreBlock sum(std::span<const ScoreBlock> blocks);

}  // namespace sim::diagnosis
