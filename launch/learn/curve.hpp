#pragma once
#include <string>
#include <vector>

#include "sim/learner/learner.hpp"

namespace launch {

/// Draws folder/curve.csv as folder/curve.svg: a panel for each unit that metrics' names end in.
/// Throws as `draw`.
void draw_curve(const std::vector<sim::learner::Metric>& metrics, const std::string& folder);

}  // namespace launch
