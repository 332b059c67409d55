#include "sim/gap/diagnosis/confounders.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

#include "interfaces/parallel/in_parallel.hpp"
#include "sim/gap/diagnosis/sensitivity.hpp"

namespace sim::diagnosis {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double rank_tolerance = 1e-9;  // of the pivots of G
// Largest remainder / previous one for a replacement; chosen.
constexpr double replacement_ratio = 0.99;

/// Scalar products of all sensitivities. Remainders are computed from these products.
class Products {
 public:
  Products(const std::vector<Sensitivity>& all, int threads) : all_(all) {
    Index columns = 0;
    for (const Sensitivity& d : all) begins_.push_back(columns), columns += d.span.cols();
    gram_.resize(columns, columns), projections_.resize(columns, static_cast<Index>(all.size()));
    in_parallel(all.size(), threads, [&](std::size_t i) {
      const MatrixXd rows = all_[i].span.transpose();
      for (std::size_t j = 0; j < all_.size(); ++j) {
        gram_.block(begins_[i], begins_[j], rows.rows(), all_[j].span.cols()) = rows * all_[j].span;
        projections_.block(begins_[i], static_cast<Index>(j), rows.rows(), 1) =
            rows * all_[j].first;
      }
    });
  }

  /// The part of |δz| of one effect that the others do not reproduce.
  double remainder(std::size_t hidden, const std::vector<std::size_t>& others) const {
    std::vector<Index> at;
    for (const std::size_t o : others)
      for (Index c = 0; c < all_[o].span.cols(); ++c) at.push_back(begins_[o] + c);
    const VectorXd b = projections_(at, static_cast<Index>(hidden));
    Eigen::CompleteOrthogonalDecomposition<MatrixXd> g;
    g.setThreshold(rank_tolerance);
    g.compute(gram_(at, at));
    return std::sqrt(std::max(0.0, all_[hidden].first.squaredNorm() - b.dot(g.solve(b))));
  }

 private:
  const std::vector<Sensitivity>& all_;
  std::vector<Index> begins_;
  MatrixXd gram_;         ///< SᵀS
  MatrixXd projections_;  ///< Sᵀδz, a column for each effect
};

struct NextEffect {
  std::size_t index = 0;
  double remaining = std::numeric_limits<double>::infinity();
};

/// The effect that, added to the chosen ones, gives the smallest remainder of `hidden`.
NextEffect next(const std::vector<Sensitivity>& all, const Products& products, std::size_t hidden,
                std::vector<std::size_t> chosen) {
  const auto type = [&](std::size_t k) { return effects::about(all[k].perturbed.effect).type; };
  NextEffect best;
  chosen.push_back(0);
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (type(k) == type(hidden) || all[k].span.cols() == 0) continue;
    chosen.back() = k;
    if (const double remaining = products.remainder(hidden, chosen); remaining < best.remaining)
      best = {k, remaining};
  }
  return best;
}

/// Replaces each chosen effect in turn if another one has a smaller remainder with the others.
/// Returns the remainder.
double exchange(const std::vector<Sensitivity>& all, const Products& products, std::size_t hidden,
                std::vector<std::size_t>& chosen, double remaining) {
  for (std::size_t unchanged = 0, at = 0; unchanged < chosen.size();
       at = (at + 1) % chosen.size()) {
    auto others = chosen;
    others.erase(others.begin() + long(at));
    const NextEffect candidate = next(all, products, hidden, others);
    const bool is_better = candidate.remaining < replacement_ratio * remaining;
    if (is_better) chosen[at] = candidate.index, remaining = candidate.remaining;
    unchanged = is_better ? 1 : unchanged + 1;
  }
  return remaining;
}

/// Adds effects until the remainder is at most `share`, or their number is `most`.
Indistinguishable confounders_of(const std::vector<Sensitivity>& all, const Products& products,
                                 std::size_t hidden, const ConfounderOptions& options) {
  const double magnitude = all[hidden].first.norm();
  double remaining = magnitude;
  std::vector<std::size_t> chosen;
  while (magnitude >= visible_change && chosen.size() < options.most &&
         remaining > options.share * magnitude) {
    const NextEffect next_effect = next(all, products, hidden, chosen);
    if (std::isinf(next_effect.remaining)) break;
    chosen.push_back(next_effect.index);
    remaining = exchange(all, products, hidden, chosen, next_effect.remaining);
  }
  Indistinguishable result{all[hidden].perturbed, {}, magnitude, remaining};
  for (const std::size_t k : chosen) result.others.push_back(all[k].perturbed);
  return result;
}

}  // namespace

std::vector<Indistinguishable> confounders(const Evaluator& evaluator,
                                           const ConfounderOptions& options) {
  const auto all = sensitivities(evaluator, options.withhold, options.threads);
  const Products products(all, options.threads);
  std::vector<Indistinguishable> found(all.size());
  in_parallel(all.size(), options.threads,
              [&](std::size_t h) { found[h] = confounders_of(all, products, h, options); });
  std::erase_if(found, [&](const Indistinguishable& t) {
    return t.others.empty() || t.remaining > options.share * t.magnitude;
  });
  std::ranges::stable_sort(found, {},
                           [](const Indistinguishable& t) { return t.remaining / t.magnitude; });
  return found;
}

}  // namespace sim::diagnosis
