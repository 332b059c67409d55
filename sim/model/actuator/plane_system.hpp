#pragma once
#include <Eigen/Core>
#include <optional>

/// Two linear first-order equations with constant input, solved in closed form.
///
///   ẋ = A x + b,   x(t) = x∞ + e^(A t) (x0 − x∞),   x∞ = −A⁻¹ b
///   e^(A t) = c(t) I + s(t) (A − m I),   m = tr A / 2,   q = m² − det A
///   q > 0: c = e^(m t) cosh √q t, s = e^(m t) sinh √q t / √q;   q < 0: the same with cos, sin
///
/// Source: Putzer's formula for the exponential of a 2×2 matrix.
namespace sim {

using Vec2 = Eigen::Vector2d;
using Mat2 = Eigen::Matrix2d;

/// c(t) and s(t) above.
struct PlaneExponential {
  double c = 1, s = 0;
};

/// The matrix A. Throws std::invalid_argument if A is not stable and invertible.
class PlaneSystem {
 public:
  explicit PlaneSystem(const Mat2& a);

  const Mat2& a() const { return a_; }
  const Mat2& a_inverse() const { return a_inverse_; }
  /// Any t ≥ 0; does not overflow.
  PlaneExponential exponential(double t_s) const;
  /// e^(A t) y.
  Vec2 apply(const PlaneExponential& e, const Vec2& y) const {
    return e.c * y + e.s * (shifted_ * y);
  }
  /// The first t > after_s where u c(t) + w s(t) = 0; empty if there is none.
  std::optional<double> first_zero(double u, double w, double after_s) const;
  const Mat2& shifted() const { return shifted_; }  ///< A − m I

 private:
  Mat2 a_, a_inverse_, shifted_;
  double mean_, root_;  ///< m, √|q|
  bool oscillates_;     ///< q < 0
};

/// One solution of a PlaneSystem, from x0 at t = 0.
class PlaneMotion {
 public:
  PlaneMotion(const PlaneSystem& system, const Vec2& x0, const Vec2& input);

  Vec2 at(const PlaneExponential& e) const { return limit_ + system_.apply(e, offset_); }
  Vec2 at(double t_s) const { return at(system_.exponential(t_s)); }
  Vec2 rate(const PlaneExponential& e) const { return system_.apply(e, rate_); }
  /// ∫ x dt from 0 to t, where x(t) is `end`.
  Vec2 integral(const Vec2& end, double t_s) const {
    return limit_ * t_s + system_.a_inverse() * (end - limit_ - offset_);
  }
  /// The first t in (0, t_end] where g = p·x + k, with g(0) ≥ 0, falls below zero. If g(0) = 0, g
  /// must rise above zero first; if it decreases at once, the result is 0.
  std::optional<double> first_fall(const Vec2& p, double k, double t_end_s) const;

 private:
  const PlaneSystem& system_;
  Vec2 limit_, offset_, rate_;  ///< x∞, x0 − x∞, ẋ(0)
};

}  // namespace sim
