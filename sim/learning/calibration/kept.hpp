#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "interfaces/xml/xml.hpp"

/// Points of the search in a strategy's state.xml.
namespace sim::calibration {

struct Kept {
  static constexpr auto element = "point";
  xml::Place place;
  std::vector<double> x, sigma;  ///< sigma: of strategies whose points have one
  double error_rad = 0;
  void visit(auto& v) {
    v.required("x", x);
    v("sigma", sigma);
    v.required("error_rad", error_rad);
  }
};

inline std::vector<double> numbers(const Eigen::VectorXd& x) { return {x.begin(), x.end()}; }
inline Eigen::VectorXd vector(const std::vector<double>& x) {
  return Eigen::Map<const Eigen::VectorXd>(x.data(), std::ssize(x));
}

/// Throws std::invalid_argument unless it is so.
inline void expect_same_search(bool same, const std::string& file) {
  if (!same)
    throw std::invalid_argument(
        file + ": of another seed, population or choice of parameters; resume with those");
}

}  // namespace sim::calibration
