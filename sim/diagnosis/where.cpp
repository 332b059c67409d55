#include "sim/diagnosis/where.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "sim/diagnosis/floor.hpp"

namespace sim::diagnosis {
namespace {

/// Sums over a block of a recording.
struct Block {
  double square = 0, floor_square = 0;
  std::size_t windows = 0;
};

/// One stage over all episodes.
struct Collected {
  Residual what;  ///< without values
  std::vector<Block> blocks;
};

void collect(const Residual& residual, double floor, std::size_t windows_a_block,
             std::vector<Block>& blocks) {
  for (std::size_t k = 0; k < residual.value.size(); ++k) {
    if (k % windows_a_block == 0) blocks.emplace_back();
    if (const double r = residual.value[k]; !std::isnan(r)) {
      blocks.back().square += r * r, blocks.back().floor_square += floor * floor;
      ++blocks.back().windows;
    }
  }
}

Block sum(std::span<const Block> blocks) {
  Block sum;
  for (const Block& b : blocks)
    sum.square += b.square, sum.floor_square += b.floor_square, sum.windows += b.windows;
  return sum;
}

double excess_of(const Block& b) { return b.floor_square > 0 ? b.square / b.floor_square - 1 : 0; }

Interval interval_of(const std::vector<Block>& blocks, const WhereOptions& options) {
  return middle(bootstrap(blocks.size(), options.draws, options.seed, [&](const auto& drawn) {
    std::vector<Block> sample;
    for (const std::size_t k : drawn) sample.push_back(blocks[k]);
    return excess_of(sum(sample));
  }));
}

std::vector<Collected> collect(const erp::Robot& robot, std::span<const Episode> episodes,
                               const WhereOptions& options) {
  const Windows windows;
  Stages stages(robot, windows);
  const auto windows_a_block =
      static_cast<std::size_t>(std::max(1.0, std::round(options.block_s / windows.stride_s)));
  std::vector<Collected> all;
  for (const Episode& episode : episodes) {
    const auto residuals = stages.residuals(episode);
    const auto floor = floors(stages, episode, robot, options.seed);
    for (std::size_t r = 0; r < residuals.size(); ++r) {
      const Residual& one = residuals[r];
      auto place = std::ranges::find_if(all, [&](const Collected& c) {
        return c.what.stage == one.stage && c.what.on == one.on;
      });
      if (place == all.end()) {
        all.push_back({{one.stage, one.on, one.unit, {}}, {}});
        place = all.end() - 1;
      }
      collect(one, floor[r], windows_a_block, place->blocks);
    }
  }
  return all;
}

StageGap gap_of(const Collected& collected, const WhereOptions& options) {
  const Block whole = sum(collected.blocks);
  const auto rms = [&](double square) {
    return whole.windows ? std::sqrt(square / static_cast<double>(whole.windows)) : 0;
  };
  StageGap gap{collected.what.stage, collected.what.on, collected.what.unit};
  gap.rms = rms(whole.square), gap.floor = rms(whole.floor_square);
  gap.windows = whole.windows;
  gap.excess = excess_of(whole);
  gap.excess_interval = interval_of(collected.blocks, options);
  gap.judged = gap.windows >= options.least_windows;
  gap.open = gap.judged && gap.excess_interval.low > options.practical_excess;
  return gap;
}

}  // namespace

std::vector<StageGap> where(const erp::Robot& robot, std::span<const Episode> episodes,
                            const WhereOptions& options) {
  std::vector<StageGap> gaps;
  for (const Collected& collected : collect(robot, episodes, options))
    gaps.push_back(gap_of(collected, options));
  if (gaps.empty())
    throw std::invalid_argument(
        "no stage can be judged: a motor needs voltage_V, shaft_rad and current_A; a tendon "
        "shaft_rad, tension_N and the angles of the joints it crosses");
  double whole = 0;
  for (const StageGap& gap : gaps)
    if (gap.open) whole += gap.excess;
  for (StageGap& gap : gaps)
    if (gap.open) gap.share = gap.excess / whole;
  std::ranges::stable_sort(gaps, std::greater(), &StageGap::share);
  return gaps;
}

}  // namespace sim::diagnosis
