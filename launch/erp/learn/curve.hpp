#pragma once
#include <string>
#include <vector>

#include "sim/learning/training_loop/learner.hpp"

namespace launch {

/// Draws folder/curve.csv as folder/curve.svg: a panel for each unit that metrics' names end in.
/// Throws as `draw`.
void draw_curve(const std::vector<sim::training_loop::Metric>& metrics, const std::string& folder);

}  // namespace launch
