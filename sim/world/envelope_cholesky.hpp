#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <vector>

/// A = L Lᵀ of a symmetric, positive definite matrix over the coordinates of a tree, parents first.
///
/// Coordinates are eliminated from the last to the first, so that leaves precede the links that
/// carry them. Branches that are not coupled then cause no fill-in in each other, and the first
/// non-zero entry of each row of L is that of A. Only the entries from there on are computed. For
/// two arms, a neck and a spine with 38 coordinates, this takes a fourth of the computation.
/// Source: Jennings 1966 (the envelope method); Featherstone 2005 (the order).
namespace sim {

class EnvelopeCholesky {
 public:
  explicit EnvelopeCholesky(int size = 0) { resize(size); }

  void resize(int size) {
    lower_.setZero(size, size);
    begin_.assign(static_cast<std::size_t>(size), 0);
    inverse_.setOnes(size);
    work_.setZero(size);
  }

  /// Factorises A, which has the size of `resize`. No heap.
  void compute(const Eigen::MatrixXd& a) {
    const auto last = a.rows() - 1;
    for (Eigen::Index i = 0; i <= last; ++i) {
      const auto row = a.col(last - i).reverse();
      Eigen::Index begin = 0;
      while (begin < i && row[begin] == 0) ++begin;
      begin_[at(i)] = begin;
      for (Eigen::Index j = begin; j < i; ++j)
        lower_(i, j) =
            (row[j] - row_product(i, j, std::max(begin, begin_[at(j)]), j)) * inverse_[j];
      lower_(i, i) = std::sqrt(row[i] - row_product(i, i, begin, i));
      inverse_[i] = 1 / lower_(i, i);
    }
  }

  /// x = A⁻¹ b.
  void solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) const {
    work_ = b.reverse();
    forward();
    for (Eigen::Index i = work_.size() - 1; i >= 0; --i) {
      const Eigen::Index begin = begin_[at(i)];
      work_[i] *= inverse_[i];
      work_.segment(begin, i - begin) -=
          work_[i] * lower_.row(i).segment(begin, i - begin).transpose();
    }
    x = work_.reverse();
  }

  /// bᵀ A⁻¹ b = |L⁻¹ b|².
  double inverse_norm2(const Eigen::VectorXd& b) const {
    work_ = b.reverse();
    forward();
    return work_.squaredNorm();
  }

 private:
  /// Inner product of two short rows; four partial sums, which the compiler vectorises.
  static double product(const double* a, const double* b, Eigen::Index n) {
    double sums[4]{};
    for (; n >= 4; n -= 4, a += 4, b += 4)
      for (int k = 0; k < 4; ++k) sums[k] += a[k] * b[k];
    double remainder = 0;
    for (; n > 0; --n) remainder += *a++ * *b++;
    return (sums[0] + sums[1]) + (sums[2] + sums[3]) + remainder;
  }
  static std::size_t at(Eigen::Index i) { return static_cast<std::size_t>(i); }
  double row_product(Eigen::Index i, Eigen::Index j, Eigen::Index begin, Eigen::Index end) const {
    return product(&lower_(i, begin), &lower_(j, begin), end - begin);
  }
  /// L⁻¹ of work_; leading zeros stay zero.
  void forward() const {
    Eigen::Index first = 0;
    while (first < work_.size() && work_[first] == 0) ++first;
    for (Eigen::Index i = first, last = first; i < work_.size(); ++i) {
      const Eigen::Index begin = std::max(begin_[at(i)], first);
      if (begin > last && work_[i] == 0) continue;
      work_[i] = (work_[i] - product(&lower_(i, begin), &work_[begin], i - begin)) * inverse_[i];
      last = i;
    }
  }

  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> lower_;
  std::vector<Eigen::Index> begin_;  ///< first column of each row
  Eigen::VectorXd inverse_;          ///< 1 / L_ii
  mutable Eigen::VectorXd work_;
};

}  // namespace sim
