#pragma once
#include <array>
#include <vector>

#include "sim/gap/residuals/column.hpp"
#include "sim/gap/residuals/skeletal.hpp"

/// A recording thinned out: means under a window (bump.hpp) at every eighth row, in which columns can
/// be scaled, exchanged and forgotten to see what would then be.
namespace sim::checks {

using residuals::Column, residuals::Episode, residuals::JointSignals, residuals::PathTrace,
    residuals::Quantity, residuals::Signal;

/// Means of the columns at some rows of a recording.
struct Means {
  struct Actuator {
    std::array<Signal, 4> measured;  ///< by Quantity
    Signal speed_rad_per_s, acceleration_rad_per_s2;
  };
  std::size_t rows = 0;
  std::vector<Actuator> actuators;
  std::vector<JointSignals> joints;
  std::vector<PathTrace> paths;  ///< under these joints

  Signal& operator[](const Column& column);
  const Signal& operator[](const Column& column) const;
  /// The column as if it had been so many times as large; not the paths.
  void scale(const Column& column, double times);
  void exchange(const Column& one, const Column& other);
  void forget(const Column& column);
};

/// Of rows `from` until before `until`; without the paths.
Means means_of(const Episode& episode, std::size_t from, std::size_t until);

}  // namespace sim::checks
