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
constexpr double worth_it = 0.99;  // an effect is replaced if the remainder falls below this share

/// Scalar products of all sensitivities: remainders are computed from these alone.
class Products {
 public:
  Products(const std::vector<Sensitivity>& all, int threads) : all_(all) {
    Index columns = 0;
    for (const Sensitivity& d : all) begins_.push_back(columns), columns += d.span.cols();
    gram_.resize(columns, columns), onto_.resize(columns, static_cast<Index>(all.size()));
    in_parallel(all.size(), threads, [&](std::size_t i) {
      const MatrixXd rows = all_[i].span.transpose();
      for (std::size_t j = 0; j < all_.size(); ++j) {
        gram_.block(begins_[i], begins_[j], rows.rows(), all_[j].span.cols()) = rows * all_[j].span;
        onto_.block(begins_[i], static_cast<Index>(j), rows.rows(), 1) = rows * all_[j].first;
      }
    });
  }

  /// |δz| of one effect that the others do not reproduce.
  double remainder(std::size_t hidden, const std::vector<std::size_t>& others) const {
    std::vector<Index> at;
    for (const std::size_t o : others)
      for (Index c = 0; c < all_[o].span.cols(); ++c) at.push_back(begins_[o] + c);
    const VectorXd b = onto_(at, static_cast<Index>(hidden));
    Eigen::CompleteOrthogonalDecomposition<MatrixXd> g;
    g.setThreshold(rank_tolerance);
    g.compute(gram_(at, at));
    return std::sqrt(std::max(0.0, all_[hidden].first.squaredNorm() - b.dot(g.solve(b))));
  }

 private:
  const std::vector<Sensitivity>& all_;
  std::vector<Index> begins_;
  MatrixXd gram_;  ///< SᵀS
  MatrixXd onto_;  ///< Sᵀδz, a column each
};

struct Next {
  std::size_t index = 0;
  double left = std::numeric_limits<double>::infinity();
};

/// The effect with the smallest remainder of `hidden` together with those chosen.
Next next(const std::vector<Sensitivity>& all, const Products& products, std::size_t hidden,
          std::vector<std::size_t> chosen) {
  const auto type = [&](std::size_t k) { return effects::about(all[k].perturbed.effect).type; };
  Next best;
  chosen.push_back(0);
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (type(k) == type(hidden) || all[k].span.cols() == 0) continue;
    chosen.back() = k;
    if (const double left = products.remainder(hidden, chosen); left < best.left) best = {k, left};
  }
  return best;
}

/// Replaces each chosen effect in turn if another has a smaller remainder with the rest. Returns the remainder.
double exchange(const std::vector<Sensitivity>& all, const Products& products, std::size_t hidden,
                std::vector<std::size_t>& chosen, double left) {
  for (std::size_t kept = 0, at = 0; kept < chosen.size(); at = (at + 1) % chosen.size()) {
    auto rest = chosen;
    rest.erase(rest.begin() + long(at));
    const Next better = next(all, products, hidden, rest);
    const bool worth = better.left < worth_it * left;
    if (worth) chosen[at] = better.index, left = better.left;
    kept = worth ? 1 : kept + 1;
  }
  return left;
}

/// Adds effects until the remainder is at most `share`, or their number is `most`.
Indistinguishable confounders_of(const std::vector<Sensitivity>& all, const Products& products,
                                 std::size_t hidden, const ConfounderOptions& options) {
  const double magnitude = all[hidden].first.norm();
  double left = magnitude;
  std::vector<std::size_t> chosen;
  while (magnitude >= shown && chosen.size() < options.most && left > options.share * magnitude) {
    const Next more = next(all, products, hidden, chosen);
    if (std::isinf(more.left)) break;
    chosen.push_back(more.index);
    left = exchange(all, products, hidden, chosen, more.left);
  }
  Indistinguishable result{all[hidden].perturbed, {}, magnitude, left};
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
