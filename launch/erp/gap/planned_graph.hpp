#pragma once
#include <string>

#include "interfaces/robot/robot.hpp"
#include "sim/gap/closed_loop/experiment.hpp"

/// The graph that `erp gap plan` writes: a motion to record next.
namespace launch::gap {

/// Removes an earlier plan's graph from a folder, so that nobody launches it. Throws std::invalid_argument of files
/// that no plan wrote.
void make_way(const std::string& folder);
/// Writes graph.xml, with what it needs: the robot to be recorded, moved by that excitation.
void write_graph(const std::string& folder, const std::string& robot_file, const erp::Robot& robot,
                 const sim::Excitation& excitation);

}  // namespace launch::gap
