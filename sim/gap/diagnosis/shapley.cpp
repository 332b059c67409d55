#include "sim/gap/diagnosis/shapley.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <map>

#include "interfaces/parallel/in_parallel.hpp"
#include "sim/gap/residuals/indices.hpp"

namespace sim::diagnosis {
namespace {

constexpr std::size_t all_subsets_of = 6;  // largest number of effects with all subsets; chosen

double factorial(std::size_t n) { return n < 2 ? 1 : static_cast<double>(n) * factorial(n - 1); }

/// A subset of the effects, one bit each.
using Set = std::uint64_t;
constexpr Set only(std::size_t k) { return Set{1} << k; }

/// Scores of subsets of the effects.
struct Subsets {
  std::size_t count;  ///< effects
  std::map<Set, std::vector<ScoreBlock>> blocks;

  Set whole() const { return only(count) - 1; }
};

/// Subsets that are needed: all of them, or for many effects none, each alone, all but each, and all.
std::vector<Set> needed(std::size_t count) {
  const Set whole = only(count) - 1;
  std::vector<Set> sets;
  if (count <= all_subsets_of)
    for (Set set = 0; set <= whole; ++set) sets.push_back(set);
  else {
    sets = {0, whole};
    for (std::size_t k = 0; k < count; ++k)
      sets.push_back(only(k)), sets.push_back(whole & ~only(k));
  }
  return sets;
}

Subsets score(const Problem& problem, std::size_t count, const BlocksOf& blocks_of) {
  Subsets subsets{count, {}};
  const auto sets = needed(count);
  for (const Set set : sets) subsets.blocks[set];
  in_parallel(sets.size(), problem.options.threads, [&](std::size_t n) {
    std::vector<bool> among(count);
    for (std::size_t k = 0; k < count; ++k) among[k] = sets[n] & only(k);
    subsets.blocks.at(sets[n]) = blocks_of(among);
  });
  return subsets;
}

/// v of each subset, over some blocks.
using Closes = std::map<Set, double>;

Closes closed(const Subsets& subsets, std::span<const std::size_t> drawn) {
  Closes v;
  const auto& before = subsets.blocks.at(0);
  double gap = 0;
  for (const std::size_t b : drawn)
    gap += before[b].square - static_cast<double>(before[b].windows);
  for (const auto& [set, blocks] : subsets.blocks) {
    double taken = 0;
    for (const std::size_t b : drawn) taken += before[b].square - blocks[b].square;
    v[set] = taken / std::max(gap, 1e-9);
  }
  return v;
}

/// φ of effect k.
double shapley(const Closes& v, std::size_t k, std::size_t count) {
  const Set whole = only(count) - 1;
  if (count > all_subsets_of) return (v.at(only(k)) + v.at(whole) - v.at(whole & ~only(k))) / 2;
  double share = 0;
  for (const auto& [set, closes] : v) {
    if (set & only(k)) continue;
    const auto size = static_cast<std::size_t>(std::popcount(set));
    const double orders = factorial(size) * factorial(count - size - 1) / factorial(count);
    share += orders * (v.at(set | only(k)) - closes);
  }
  return share;
}

}  // namespace

ShapleyValues shapley_values(const Problem& problem, std::size_t count, const BlocksOf& blocks_of) {
  const Subsets subsets = score(problem, count, blocks_of);
  const Set whole = subsets.whole();
  const auto every = each(subsets.blocks.at(0).size());
  const Closes v = closed(subsets, every);
  ShapleyValues result{{}, {}, {}, v.at(whole)};
  const auto interval = [&](auto of) {
    return middle(bootstrap(every.size(), 400, problem.options.seed,
                            [&](const auto& drawn) { return of(closed(subsets, drawn)); }));
  };
  for (std::size_t k = 0; k < count; ++k) {
    result.share.push_back(shapley(v, k, count));
    result.interaction -= v.at(only(k));
    result.interval.push_back(interval([&](const Closes& w) { return shapley(w, k, count); }));
    result.lost.push_back(
        interval([&](const Closes& w) { return w.at(whole) - w.at(whole & ~only(k)); }));
  }
  return result;
}

ShapleyValues shapley_values(const Problem& problem, const Evaluator& evaluator,
                             const std::vector<effects::Placed>& effect_set) {
  const auto& held_out = problem.sets.held_out;
  return shapley_values(problem, effect_set.size(), [&](const std::vector<bool>& among) {
    std::vector<effects::Placed> some;
    for (std::size_t k = 0; k < effect_set.size(); ++k)
      if (among[k]) some.push_back(effect_set[k]);
    return evaluator.blocks(some.empty() ? evaluator.bare() : evaluator.with(some, held_out),
                            held_out);
  });
}

}  // namespace sim::diagnosis
