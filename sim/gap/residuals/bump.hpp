#pragma once
#include <cstddef>
#include <span>
#include <vector>

/// Means and derivatives of sampled signals under a smooth window (weak form). Both sides of an
/// equation have the same weights, and its derivatives are moved to the window. Thus a law is
/// evaluated without differentiation of noise.
///
///   ⟨x⟩ = Σ φ_j x_k+j     φ(t) ~ (1 − (t/T)²)³, |t| < T, Σ φ_j = 1
///   ⟨ẋ⟩ = ⟨(x_k+1 − x_k−1)/2Δ⟩     ⟨ẍ⟩ = ⟨(x_k+1 − 2 x_k + x_k−1)/Δ²⟩
///
/// Δ: period; T: half width. The differences are applied to φ instead of x. They are exact for a
/// motion whose acceleration is constant between samples; derivatives of φ would not be.
/// Source: weak-form identification (Messenger, Bortz 2021); modulating functions (Shinbrot 1957).
namespace sim::residuals {

class Bump {
 public:
  /// `half_width_s`: T, at least three periods.
  Bump(double half_width_s, double period_s);

  /// Number of samples on each side of the middle. The outermost ones have a weight only in
  /// derivatives.
  std::size_t reach() const { return mean_.size() / 2; }
  /// ⟨x⟩, ⟨ẋ⟩ and ⟨ẍ⟩ around row k; reach() ≤ k < x.size() − reach(). NaN if a sample in the window
  /// is missing.
  double mean(std::span<const double> x, std::size_t k) const { return sum(mean_, x, k); }
  double rate(std::span<const double> x, std::size_t k) const { return sum(rate_, x, k); }
  double acceleration(std::span<const double> x, std::size_t k) const {
    return sum(curvature_, x, k);
  }
  /// ⟨ẋ⟩ at every row; NaN at the first and last reach() rows.
  std::vector<double> rates(std::span<const double> x) const;

 private:
  double sum(const std::vector<double>& weights, std::span<const double> x, std::size_t k) const;
  std::vector<double> mean_, rate_, curvature_;
};

}  // namespace sim::residuals
