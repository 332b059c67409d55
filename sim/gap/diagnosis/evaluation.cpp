#include "sim/gap/diagnosis/evaluation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "sim/gap/residuals/band.hpp"

namespace sim::diagnosis {

Evaluator::Evaluator(const erp::Robot& nominal, std::vector<residuals::Episode> episodes,
                     std::uint64_t seed)
    : nominal_(nominal), episodes_(std::move(episodes)), seed_(seed) {
  residuals::Stages stages(nominal);
  bool has_stage = false;
  for (const residuals::Episode& episode : episodes_) {
    nominal_evaluation_.of_episode.push_back(stages.explain(episode));
    floors_.push_back(residuals::floors(stages, episode, nominal, seed));
    has_stage |= !nominal_evaluation_.of_episode.back().residuals.empty();
  }
  if (!has_stage)
    throw std::invalid_argument(
        nominal.drives.empty()
            ? "no stage can be evaluated: a motor needs voltage_V, shaft_rad and current_A; a "
              "tendon "
              "needs shaft_rad, tension_N and the angles of the joints that it crosses"
            : "no stage can be evaluated: a drive needs control_V and its position: position_m of "
              "a "
              "slide, position_rad of a shaft");
}

erp::Robot Evaluator::robot_with(std::span<const effects::Placed> all) const {
  erp::Robot robot = nominal_;
  for (const effects::Placed& placed : all) robot.effects.push_back(effects::written(placed));
  return robot;
}

std::vector<residuals::Floor> Evaluator::floor_under(const Evaluation& evaluation,
                                                     std::size_t episode) const {
  residuals::Stages stages(robot_with(evaluation.effects));
  return residuals::floors(stages, episodes_[episode], nominal_, seed_);
}

Evaluation Evaluator::with(const Evaluation& base, const effects::Placed& added,
                           std::span<const std::size_t> episodes) const {
  std::vector<effects::Placed> all = base.effects;
  all.push_back(added);
  return with_one_changed(base, std::move(all), added, episodes);
}

Evaluation Evaluator::changed(const Evaluation& base, std::size_t k, const effects::Placed& other,
                              std::span<const std::size_t> episodes) const {
  std::vector<effects::Placed> all = base.effects;
  all[k] = other;
  const auto estimated = [&](std::size_t e) { return base.of_episode[e].joints->estimated; };
  if (std::ranges::any_of(episodes, estimated) &&
      residuals::Stages(robot_with(all)).reach(other).line)
    return with(all, episodes);  // the search for joint angles must start at the same angles
  return with_one_changed(base, std::move(all), other, episodes);
}

Evaluation Evaluator::with_one_changed(const Evaluation& base, std::vector<effects::Placed> all,
                                       const effects::Placed& differs,
                                       std::span<const std::size_t> episodes) const {
  Evaluation evaluation{std::move(all), std::vector<residuals::Explanation>(episodes_.size())};
  residuals::Stages stages(robot_with(evaluation.effects));
  const residuals::Reach reach = stages.reach(differs);
  for (const std::size_t e : episodes)
    evaluation.of_episode[e] = stages.explain(episodes_[e], base.of_episode[e], reach);
  return evaluation;
}

Evaluation Evaluator::with(std::span<const effects::Placed> all,
                           std::span<const std::size_t> episodes) const {
  Evaluation evaluation{{all.begin(), all.end()},
                        std::vector<residuals::Explanation>(episodes_.size())};
  residuals::Stages stages(robot_with(all));
  const auto reaches = [&](auto what) {
    return std::ranges::any_of(all, [&](const auto& placed) { return what(stages.reach(placed)); });
  };
  const bool changes_joints =
      reaches([](const residuals::Reach& r) { return r.joints || r.path.has_value(); });
  for (const std::size_t k : episodes)
    evaluation.of_episode[k] = stages.explain(
        episodes_[k], changes_joints ? nullptr : nominal_evaluation_.of_episode[k].joints);
  return evaluation;
}

std::vector<double> Evaluator::whitened(const Evaluation& evaluation, std::size_t episode) const {
  const auto& nominal = nominal_evaluation_.of_episode[episode].residuals;
  const auto& changed = evaluation.of_episode[episode].residuals;
  std::vector<double> all;
  for (std::size_t r = 0; r < nominal.size(); ++r) {
    const residuals::Floor& floor = floors_[episode][r];
    for (std::size_t k = 0; k < nominal[r].value.size(); ++k) {
      const bool judged = floor.rms > 0 && !std::isnan(nominal[r].value[k]);
      const bool available = r < changed.size() && !std::isnan(changed[r].value[k]);
      all.push_back(
          judged ? residuals::normalized(available ? changed[r] : nominal[r], k, floor.by_window[k])
                 : std::numeric_limits<double>::quiet_NaN());
    }
  }
  return all;
}

std::vector<ScoreBlock> Evaluator::blocks(
    const Evaluation& evaluation, std::span<const std::size_t> episodes,
    const std::function<bool(const residuals::Residual&)>& counts, double block_s) const {
  std::vector<ScoreBlock> blocks;
  for (const std::size_t e : episodes) {
    const auto z = whitened(evaluation, e);
    const auto& residuals = nominal_evaluation_.of_episode[e].residuals;
    const std::size_t windows = nominal_evaluation_.of_episode[e].rows.size(),
                      first = blocks.size();
    const auto windows_a_block =
        std::max<std::size_t>(1, static_cast<std::size_t>(block_s / residuals::Windows{}.stride_s));
    blocks.resize(first + (windows + windows_a_block - 1) / windows_a_block);
    for (std::size_t r = 0; r < residuals.size(); ++r) {
      if (counts && !counts(residuals[r])) continue;
      for (std::size_t k = 0; k < windows; ++k) {
        const double value = z[r * windows + k];
        if (std::isnan(value)) continue;
        ScoreBlock& block = blocks[first + k / windows_a_block];
        block.square += value * value, ++block.windows;
      }
    }
  }
  return blocks;
}

ScoreBlock sum(std::span<const ScoreBlock> blocks) {
  ScoreBlock sum;
  for (const ScoreBlock& b : blocks) sum.square += b.square, sum.windows += b.windows;
  return sum;
}

}  // namespace sim::diagnosis
