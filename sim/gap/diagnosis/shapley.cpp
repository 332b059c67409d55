#include "sim/gap/diagnosis/shapley.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <map>

#include "interfaces/parallel/in_parallel.hpp"
#include "sim/gap/residuals/indices.hpp"

namespace sim::diagnosis {
namespace {

constexpr int shapley_draws = 400;         // chosen
constexpr std::size_t all_subsets_of = 6;  // largest number of effects with all subsets; chosen

double factorial(std::size_t n) { return n < 2 ? 1 : static_cast<double>(n) * factorial(n - 1); }

/// A subset of the effects, one bit each.
using Set = std::uint64_t;
constexpr Set single(std::size_t k) { return Set{1} << k; }

/// Scores of subsets of the effects.
struct Subsets {
  std::size_t count;  ///< effects
  std::map<Set, std::vector<ScoreBlock>> blocks;

  Set total() const { return single(count) - 1; }
};

/// The evaluated subsets: all subsets; for many effects the empty one, each effect, all but each,
/// and all effects.
std::vector<Set> evaluated_subsets(std::size_t count) {
  const Set total = single(count) - 1;
  std::vector<Set> sets;
  if (count <= all_subsets_of)
    for (Set set = 0; set <= total; ++set) sets.push_back(set);
  else {
    sets = {0, total};
    for (std::size_t k = 0; k < count; ++k)
      sets.push_back(single(k)), sets.push_back(total & ~single(k));
  }
  return sets;
}

Subsets score(const Problem& problem, std::size_t count, const BlocksOf& blocks_of) {
  Subsets subsets{count, {}};
  const auto sets = evaluated_subsets(count);
  for (const Set set : sets) subsets.blocks[set];
  in_parallel(sets.size(), problem.options.threads, [&](std::size_t n) {
    std::vector<bool> is_included(count);
    for (std::size_t k = 0; k < count; ++k) is_included[k] = sets[n] & single(k);
    subsets.blocks.at(sets[n]) = blocks_of(is_included);
  });
  return subsets;
}

/// v of each subset, over drawn blocks.
using ClosedBySubset = std::map<Set, double>;

ClosedBySubset closed(const Subsets& subsets, std::span<const std::size_t> drawn) {
  ClosedBySubset v;
  const auto& before = subsets.blocks.at(0);
  double gap = 0;
  for (const std::size_t b : drawn)
    gap += before[b].square - static_cast<double>(before[b].windows);
  for (const auto& [set, blocks] : subsets.blocks) {
    double removed = 0;
    for (const std::size_t b : drawn) removed += before[b].square - blocks[b].square;
    v[set] = removed / std::max(gap, 1e-9);
  }
  return v;
}

/// φ of effect k.
double shapley(const ClosedBySubset& v, std::size_t k, std::size_t count) {
  const Set total = single(count) - 1;
  if (count > all_subsets_of) return (v.at(single(k)) + v.at(total) - v.at(total & ~single(k))) / 2;
  double share = 0;
  for (const auto& [set, closes] : v) {
    if (set & single(k)) continue;
    const auto size = static_cast<std::size_t>(std::popcount(set));
    const double orders = factorial(size) * factorial(count - size - 1) / factorial(count);
    share += orders * (v.at(set | single(k)) - closes);
  }
  return share;
}

}  // namespace

ShapleyValues shapley_values(const Problem& problem, std::size_t count, const BlocksOf& blocks_of) {
  const Subsets subsets = score(problem, count, blocks_of);
  const Set total = subsets.total();
  const auto all_blocks = each(subsets.blocks.at(0).size());
  const ClosedBySubset v = closed(subsets, all_blocks);
  ShapleyValues result{{}, {}, {}, v.at(total)};
  const auto interval = [&](auto of) {
    return middle(bootstrap(all_blocks.size(), shapley_draws, problem.options.seed,
                            [&](const auto& drawn) { return of(closed(subsets, drawn)); }));
  };
  for (std::size_t k = 0; k < count; ++k) {
    result.share.push_back(shapley(v, k, count));
    result.interaction -= v.at(single(k));
    result.interval.push_back(
        interval([&](const ClosedBySubset& w) { return shapley(w, k, count); }));
    result.lost.push_back(
        interval([&](const ClosedBySubset& w) { return w.at(total) - w.at(total & ~single(k)); }));
  }
  return result;
}

ShapleyValues shapley_values(const Problem& problem, const Evaluator& evaluator,
                             const std::vector<effects::Placed>& effect_set) {
  const auto& held_out = problem.sets.held_out;
  return shapley_values(problem, effect_set.size(), [&](const std::vector<bool>& is_included) {
    std::vector<effects::Placed> included;
    for (std::size_t k = 0; k < effect_set.size(); ++k)
      if (is_included[k]) included.push_back(effect_set[k]);
    return evaluator.blocks(
        included.empty() ? evaluator.nominal_evaluation() : evaluator.with(included, held_out),
        held_out);
  });
}

}  // namespace sim::diagnosis
