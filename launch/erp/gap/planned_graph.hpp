#pragma once
#include <string>

#include "interfaces/robot/robot.hpp"
#include "sim/gap/closed_loop/experiment.hpp"

/// The graph that `erp gap plan` writes: the motion of the next experiment.
namespace launch::gap {

/// Removes the graph of an earlier plan from a folder: it cannot be launched by mistake. Throws
/// std::invalid_argument if the folder contains files with the same names that erp gap plan did not
/// write.
void remove_earlier_plan(const std::string& folder);
/// Writes graph.xml, reference.xml and trajectory.csv: a graph in which the robot executes the
/// excitation and the logger records it.
void write_graph(const std::string& folder, const std::string& robot_file, const erp::Robot& robot,
                 const sim::Excitation& excitation);

}  // namespace launch::gap
