#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "interfaces/graph/graph.hpp"

/// What every component's command line says.
namespace node {

struct Options {
  std::string type;   ///< the program's own name
  std::string name;   ///< in the graph; the key of what it publishes
  std::string robot;  ///< robot.xml; empty: none
  std::string config;
  std::vector<std::pair<std::string, std::string>> settings;  ///< --set key=value
  erp::Time time = erp::Time::realtime;
  bool managed = false;   ///< wait for the launcher before becoming active
  double duration_s = 0;  ///< for devices: end the run by yourself; 0: never
  int priority = 0;       ///< of a controller: the higher number drives
  bool check = false;     ///< only check config and settings, then exit
};

/// Reads the command line; prints help, or a mistake with its remedy, and sets `exit_code` when
/// the program should end right away (otherwise −1). `parameters` is shown by --help.
Options parse_options(int argc, char** argv, const std::string& parameters, int& exit_code);

}  // namespace node
