#include "sim/model/actuator/plane_system.hpp"

#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace sim {

PlaneSystem::PlaneSystem(const Mat2& a)
    : a_(a),
      a_inverse_(a.inverse()),
      shifted_(a - 0.5 * a.trace() * Mat2::Identity()),
      mean_(0.5 * a.trace()) {
  // q from the shifted matrix, whose square is q I; avoids cancellation of m² and det A.
  const double q = -shifted_.determinant();
  oscillates_ = q < 0;
  root_ = std::sqrt(std::abs(q));
  if (!(a.trace() < 0) || !(a.determinant() > 0))
    throw std::invalid_argument("the motor's equations are unstable; check its constants");
}

PlaneExponential PlaneSystem::exponential(double t) const {
  if (oscillates_) {
    const double decay = std::exp(mean_ * t);
    return {decay * std::cos(root_ * t), decay * std::sin(root_ * t) / root_};
  }
  const double slow_mode = std::exp((mean_ + root_) * t);
  const double complement = -std::expm1(-2 * root_ * t);  // 1 − e^(−2√q t)
  return {slow_mode * (1 - 0.5 * complement),
          root_ > 0 ? slow_mode * complement / (2 * root_) : slow_mode * t};
}

std::optional<double> PlaneSystem::first_zero(double u, double w, double after) const {
  if (oscillates_) {  // tan(√|q| t) / √|q| = −u / w
    const double period = std::numbers::pi / root_;
    double t = std::atan2(-u * root_, w) / root_;
    t += period * std::ceil((after - t) / period);
    return t > after ? t : t + period;
  }
  if (w == 0) return std::nullopt;
  const double ratio = -u / w * root_;  // tanh √q t
  if (root_ == 0) return -u / w > after ? std::optional(-u / w) : std::nullopt;
  if (!(std::abs(ratio) < 1)) return std::nullopt;
  const double t = std::atanh(ratio) / root_;
  return t > after ? std::optional(t) : std::nullopt;
}

PlaneMotion::PlaneMotion(const PlaneSystem& system, const Vec2& x0, const Vec2& input)
    : system_(system),
      limit_(-(system.a_inverse() * input)),
      offset_(x0 - limit_),
      rate_(system.a() * x0 + input) {}

namespace {

constexpr int max_bisections = 100;  // chosen
constexpr double rounding = 1e-15;   // relative width of the interval at which the search ends
constexpr int bisection_every = 3;   // chosen: guarantees that the interval shrinks

/// The root of a function that falls from ≥ 0 at `low` to < 0 at `high`, by bisection and secant.
template <class Function>
double falling_root(const Function& g, double low, double high) {
  double g_low = g(low), g_high = g(high);
  for (int i = 0; i < max_bisections && high - low > rounding * high; ++i) {
    const double secant = low + (high - low) * g_low / (g_low - g_high);
    const bool use_secant =
        i % bisection_every != bisection_every - 1 && secant > low && secant < high;
    const double t = use_secant ? secant : 0.5 * (low + high);
    const double g_t = g(t);
    if (g_t >= 0) low = t, g_low = g_t;
    else high = t, g_high = g_t;
    if (g_t == 0) break;
  }
  return low;
}
}  // namespace

std::optional<double> PlaneMotion::first_fall(const Vec2& p, double k, double t_end) const {
  const auto g = [&](double t) { return p.dot(at(t)) + k; };
  // ġ = c p·ẋ0 + s p·(A − m I) ẋ0: between its zeros g is monotone.
  const double u = p.dot(rate_), w = p.dot(system_.shifted() * rate_);
  const bool starts_at_zero = !(p.dot(limit_ + offset_) + k > 0);
  double low = 0;
  while (true) {
    const auto extremum = system_.first_zero(u, w, low);
    const double high = extremum && *extremum < t_end ? *extremum : t_end;
    if (g(high) < 0) {
      // If g(0) = 0, a zero at the very start is due to rounding and is skipped.
      const bool dips_at_start = starts_at_zero && low == 0 && high < t_end;
      if (!dips_at_start || g(t_end) < 0)
        return starts_at_zero && low == 0 ? 0.0 : falling_root(g, low, high);
    }
    if (high >= t_end) return std::nullopt;
    low = high;
  }
}

}  // namespace sim
