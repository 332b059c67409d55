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

constexpr double alike = 1e-9;     // of G's pivots: below it two changes are one
constexpr double worth_it = 0.99;  // of what was left, at most: another takes the place of one

/// Products of all directions: what each leaves is then told without the recordings.
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

  /// |δz| of one, once others stand for it.
  double left(std::size_t hidden, const std::vector<std::size_t>& others) const {
    std::vector<Index> at;
    for (const std::size_t o : others)
      for (Index c = 0; c < all_[o].span.cols(); ++c) at.push_back(begins_[o] + c);
    const VectorXd b = onto_(at, static_cast<Index>(hidden));
    Eigen::CompleteOrthogonalDecomposition<MatrixXd> g;
    g.setThreshold(alike);
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
  std::size_t who = 0;
  double left = std::numeric_limits<double>::infinity();
};

/// The one that leaves least of what is hidden beside those chosen.
Next next(const std::vector<Sensitivity>& all, const Products& products, std::size_t hidden,
          std::vector<std::size_t> chosen) {
  const auto type = [&](std::size_t k) { return effects::about(all[k].perturbed.effect).type; };
  Next best;
  chosen.push_back(0);
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (type(k) == type(hidden) || all[k].span.cols() == 0) continue;
    chosen.back() = k;
    if (const double left = products.left(hidden, chosen); left < best.left) best = {k, left};
  }
  return best;
}

/// Lets each of those chosen go in turn, if another beside the rest leaves less. Returns what is left.
double exchange(const std::vector<Sensitivity>& all, const Products& products, std::size_t hidden,
                std::vector<std::size_t>& chosen, double left) {
  for (std::size_t kept = 0, at = 0; kept < chosen.size(); at = (at + 1) % chosen.size()) {
    auto rest = chosen;
    rest.erase(rest.begin() + long(at));
    const Next better = next(all, products, hidden, rest);
    const bool worth = better.left < worth_it * left;
    if (worth) chosen[at] = better.who, left = better.left;
    kept = worth ? 1 : kept + 1;
  }
  return left;
}

/// The fewest that leave at most `share`, or as many as there may be.
Indistinguishable stand_in(const std::vector<Sensitivity>& all, const Products& products,
                           std::size_t hidden, const ConfounderOptions& options) {
  const double shows = all[hidden].first.norm();
  double left = shows;
  std::vector<std::size_t> chosen;
  while (shows >= shown && chosen.size() < options.most && left > options.share * shows) {
    const Next more = next(all, products, hidden, chosen);
    if (std::isinf(more.left)) break;
    chosen.push_back(more.who);
    left = exchange(all, products, hidden, chosen, more.left);
  }
  Indistinguishable twin{all[hidden].perturbed, {}, shows, left};
  for (const std::size_t k : chosen) twin.others.push_back(all[k].perturbed);
  return twin;
}

}  // namespace

std::vector<Indistinguishable> confounders(const Evaluator& evaluator,
                                           const ConfounderOptions& options) {
  const auto all = sensitivities(evaluator, options.withhold, options.threads);
  const Products products(all, options.threads);
  std::vector<Indistinguishable> indistinguishable_effects(all.size());
  in_parallel(all.size(), options.threads, [&](std::size_t h) {
    indistinguishable_effects[h] = stand_in(all, products, h, options);
  });
  std::erase_if(indistinguishable_effects, [&](const Indistinguishable& t) {
    return t.others.empty() || t.left > options.share * t.shows;
  });
  std::ranges::stable_sort(indistinguishable_effects, {},
                           [](const Indistinguishable& t) { return t.left / t.shows; });
  return indistinguishable_effects;
}

}  // namespace sim::diagnosis
