#pragma once
#include <array>
#include <vector>

#include "sim/gap/residuals/column.hpp"
#include "sim/gap/residuals/skeletal.hpp"

/// A downsampled recording: means under a window (bump.hpp) at every eighth row. Corrections scale,
/// exchange and remove its columns.
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
  std::vector<PathTrace> paths;  ///< of the tendons at these joint angles, by actuator

  Signal& operator[](const Column& column);
  const Signal& operator[](const Column& column) const;
  /// Multiplies a column by `factor`; for a shaft angle, its derivatives too. Does not update the
  /// paths.
  void scale(const Column& column, double factor);
  void exchange(const Column& one, const Column& other);
  void remove(const Column& column);
};

/// Means of the rows `first` … `end` − 1, without the paths.
Means means_of(const Episode& episode, std::size_t first, std::size_t end);

}  // namespace sim::checks
