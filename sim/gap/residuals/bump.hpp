#pragma once
#include <cstddef>
#include <span>
#include <vector>

/// Means and derivatives of sampled signals under one smooth window, so that a law can be checked
/// without differentiation of noise: both sides of an equation have the same weights, and derivatives are moved to the
/// window (weak form).
///
///   ⟨x⟩ = Σ φ_j x_k+j     φ(t) ~ (1 − (t/T)²)³, |t| < T, Σ φ_j = 1
///   ⟨ẋ⟩ = ⟨(x_k+1 − x_k−1)/2Δ⟩     ⟨ẍ⟩ = ⟨(x_k+1 − 2 x_k + x_k−1)/Δ²⟩
///
/// with the differences applied to φ instead of x. Differences, not derivatives of φ: a motion whose acceleration is
/// constant between samples satisfies them exactly.
/// Source: weak-form identification (Messenger, Bortz 2021); modulating functions (Shinbrot 1957).
namespace sim::residuals {

class Bump {
 public:
  /// `half_width_s`: T, at least three periods.
  Bump(double half_width_s, double period_s);

  /// Samples on each side of the middle; the outermost have a weight in derivatives only.
  std::size_t reach() const { return mean_.size() / 2; }
  /// Around row k; reach() ≤ k < x.size() − reach(). NaN if a sample in the window is missing.
  double mean(std::span<const double> x, std::size_t k) const { return sum(mean_, x, k); }
  double rate(std::span<const double> x, std::size_t k) const { return sum(rate_, x, k); }
  double acceleration(std::span<const double> x, std::size_t k) const {
    return sum(curvature_, x, k);
  }
  /// ⟨ẋ⟩ at every row; NaN near the ends.
  std::vector<double> rates(std::span<const double> x) const;

 private:
  double sum(const std::vector<double>& weights, std::span<const double> x, std::size_t k) const;
  std::vector<double> mean_, rate_, curvature_;
};

}  // namespace sim::residuals
