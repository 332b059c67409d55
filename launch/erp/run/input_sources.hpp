#pragma once
#include <vector>

#include "interfaces/graph/graph.hpp"
#include "launch/erp/run/plan.hpp"

namespace launch {

/// On a real robot (device="can" hardware="true") no simulator publishes the true joint angles or
/// body poses, or renders images. Throws xml::Errors with one error for each component of the graph
/// that can therefore never get its input. `settings`: of the command line, override the configs.
void check_input_sources(const erp::Graph& graph, const std::vector<Setting>& settings);

}  // namespace launch
