#include "sim/diagnosis/shares.hpp"

#include <bit>

#include "sim/residuals/indices.hpp"

namespace sim::diagnosis {
namespace {

double factorial(std::size_t n) { return n < 2 ? 1 : static_cast<double>(n) * factorial(n - 1); }

/// φ from v, whose index has a bit for each effect that is there.
std::vector<double> shapley(const std::vector<double>& v, std::size_t count) {
  std::vector<double> share(count, 0.0);
  for (std::size_t set = 0; set < v.size(); ++set)
    for (std::size_t k = 0; k < count; ++k) {
      if (set >> k & 1) continue;
      const auto size = static_cast<std::size_t>(std::popcount(set));
      const double orders = factorial(size) * factorial(count - size - 1) / factorial(count);
      share[k] += orders * (v[set | std::size_t{1} << k] - v[set]);
    }
  return share;
}

/// Scores of every subset, whose index has a bit for each effect that is there.
using Subsets = std::vector<std::vector<ScoreBlock>>;

Subsets score(const Evidence& evidence, const Trials& trials,
              const std::vector<effects::Placed>& together) {
  Subsets blocks(std::size_t{1} << together.size());
  const auto& held_out = evidence.sets.held_out;
  for (std::size_t set = 0; set < blocks.size(); ++set) {
    std::vector<effects::Placed> some;
    for (std::size_t k = 0; k < together.size(); ++k)
      if (set >> k & 1) some.push_back(together[k]);
    blocks[set] = trials.blocks(set == 0 ? trials.bare() : trials.with(some, held_out), held_out);
  }
  return blocks;
}

/// v of every subset, over some blocks.
std::vector<double> closed(const Subsets& blocks, std::span<const std::size_t> drawn) {
  std::vector<double> v(blocks.size(), 0.0);
  double gap = 0;
  for (const std::size_t b : drawn) {
    gap += blocks[0][b].square - static_cast<double>(blocks[0][b].windows);
    for (std::size_t set = 0; set < v.size(); ++set)
      v[set] += blocks[0][b].square - blocks[set][b].square;
  }
  for (double& x : v) x /= std::max(gap, 1e-9);
  return v;
}

}  // namespace

Shares shares(const Evidence& evidence, const Trials& trials,
              const std::vector<effects::Placed>& together) {
  const std::size_t count = together.size();
  const Subsets blocks = score(evidence, trials, together);
  const auto every = each(blocks[0].size());
  const auto v = closed(blocks, every);
  Shares result{shapley(v, count), {}, {}, v.back()};
  const auto interval = [&](auto of) {
    return middle(bootstrap(every.size(), 400, evidence.options.seed,
                            [&](const auto& drawn) { return of(closed(blocks, drawn)); }));
  };
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t alone = std::size_t{1} << k;
    result.interaction -= v[alone];
    result.interval.push_back(interval([&](const auto& w) { return shapley(w, count)[k]; }));
    result.lost.push_back(
        interval([&](const auto& w) { return w.back() - w[w.size() - 1 - alone]; }));
  }
  return result;
}

}  // namespace sim::diagnosis
