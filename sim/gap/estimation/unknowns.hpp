#pragma once
#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "sim/gap/estimation/constants.hpp"

/// The unknowns of a robot: its constants, then the parameters of its effects.
namespace sim::estimation {

/// A robot and its uncertain constants.
struct Uncertain {
  erp::Robot nominal;
  std::vector<Constant> constants;
  /// For each constant, whether it is far off (far_off.hpp); empty: not known yet.
  std::vector<bool> far = {};
};

/// Values of the unknowns.
struct Point {
  std::vector<double> x;                 ///< one per constant, in tolerances
  std::vector<effects::Placed> effects;  ///< with their parameters
};

erp::Robot robot_at(const Uncertain& uncertain, const Point& point);

/// −2 log of the prior of x. If it is unknown which constants are far off, ν log(1 + x²/ν), ν = 6: near 0 a normal
/// distribution of standard deviation 1, with the heavier tails of Student's t, so that a constant far off costs little
/// more than one that is three tolerances off. If it is known, x², and x²/far² + price for constants that are far off.
double prior_cost(const Uncertain& uncertain, const Point& point);
/// Precision of the normal distribution with the same slope at the point.
double prior_precision(const Uncertain& uncertain, const Point& point, std::size_t k);

inline double far_precision(const Constant& c) { return 1 / (c.far * c.far); }
/// −2 log of the odds that a constant is far off, 15 %, and of the normalization of the wider prior; for a zero, the
/// cost of five tolerances; chosen.
inline double far_price(const Constant& c) { return c.zero ? 25 : 3.5 + 2 * std::log(c.far); }

/// Whether a parameter is estimated: those that are fitted elsewhere too, and times and speeds, which are scanned
/// elsewhere; not counts (a cogging's periods).
bool is_estimated(const effects::Parameter& parameter);

/// The coordinates of a point in sequence: x, then each estimated parameter, as its logarithm if it is not fitted
/// elsewhere.
class Unknowns {
 public:
  /// `uncertain` must outlive this object.
  Unknowns(const Uncertain& uncertain, Point at);

  std::size_t count() const { return at_.x.size() + places_.size(); }
  std::size_t constants() const { return at_.x.size(); }
  const Uncertain& uncertain() const { return *uncertain_; }
  const Point& point() const { return at_; }
  erp::Robot robot() const { return robot_at(*uncertain_, at_); }

  double value(std::size_t k) const;
  /// Step of a forward difference, within the bounds. It is so small that no window enters or leaves a friction band,
  /// and no tendon becomes taut or slack.
  double step(std::size_t k, double stretch = 1) const;
  /// Returns a copy with another value of one unknown, or with all moved; parameters stay within their bounds.
  Unknowns with(std::size_t k, double value) const;
  Unknowns moved(const Eigen::VectorXd& by) const;
  residuals::Reach reach(std::size_t k, const residuals::Stages& stages) const;
  bool at_bound(std::size_t k) const;
  bool is_logarithm(std::size_t k) const { return k >= constants() && !parameter(k).fitted; }

 private:
  struct Place {
    std::size_t effect, parameter;
  };
  effects::Parameter parameter(std::size_t k) const;

  const Uncertain* uncertain_;
  Point at_;
  std::vector<Place> places_;
};

}  // namespace sim::estimation
