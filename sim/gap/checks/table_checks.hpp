#pragma once
#include <string>
#include <vector>

#include "interfaces/recording/table.hpp"
#include "interfaces/robot/robot.hpp"

/// What is odd about a recording before a law is asked: columns of nobody, rows too far apart
/// or not even.
namespace sim::checks {

/// One sentence each, with a remedy; empty: nothing.
///
///   columns that begin with no actuator, joint or drive of the robot, which are passed over
///   rows further apart than the ECUs' ticks: what is fast between two of them is not in the recording,
///   and the laws of motors and gearboxes do not hold without it. Says nothing of drives.
///   rows that come early and late by more than 3 % of their period, unless their frames are numbered
std::vector<std::string> table_checks(const recording::Table& table, const erp::Robot& robot,
                                      const std::string& name);

}  // namespace sim::checks
