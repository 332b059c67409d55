#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "interfaces/xml/xml.hpp"

/// A point of the search in a strategy's state.xml.
namespace sim::calibration {

struct SavedPoint {
  static constexpr auto element = "point";
  xml::Place place;
  std::vector<double> x, sigma;  ///< sigma: empty for strategies without step sizes
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

/// Throws std::invalid_argument unless the checkpoint belongs to the same search.
inline void expect_same_search(bool is_same_search, const std::string& file) {
  if (!is_same_search)
    throw std::invalid_argument(file +
                                ": was written with another seed, population or choice of "
                                "parameters; resume with the same");
}

}  // namespace sim::calibration
