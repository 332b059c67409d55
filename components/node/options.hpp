#pragma once
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "interfaces/graph/graph.hpp"

/// The command line that all components share.
namespace node {

struct Options {
  std::string type;   ///< name of the program
  std::string name;   ///< component name in the graph; key of its messages
  std::string robot;  ///< robot.xml; empty: none
  std::string config;
  std::vector<std::pair<std::string, std::string>> settings;  ///< --set key=value
  erp::Time time = erp::Time::realtime;
  bool managed = false;   ///< stay inactive until the launcher activates it
  double duration_s = 0;  ///< devices: length of the run; 0: no end
  int priority = 0;       ///< controllers: the highest number takes control
  bool check = false;     ///< check config and settings, then exit
};

/// Parses the command line. Prints help or an error if needed and then sets `exit_code` to the exit
/// code of the program; otherwise sets it to −1. --help and --describe print `parameters`.
Options parse_options(int argc, char** argv, const std::string& parameters, int& exit_code);

}  // namespace node
