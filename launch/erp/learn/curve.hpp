#pragma once
#include <string>
#include <vector>

#include "sim/learning/training_loop/training_loop.hpp"

namespace launch {

/// Draws folder/curve.csv as folder/curve.svg, with one panel for each unit at the end of the
/// metrics' names. Throws as `draw`.
void draw_curve(const std::vector<sim::training_loop::Metric>& metrics, const std::string& folder);

}  // namespace launch
