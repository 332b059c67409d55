#pragma once
#include <optional>
#include <string>
#include <vector>

#include "interfaces/graph/graph.hpp"

/// `erp launch GRAPH.xml`.
namespace launch {

struct LaunchOptions {
  std::string graph_file;
  std::string device;                 ///< sim, can, replay:FILE; empty: as in the graph
  std::optional<erp::Time> time;      ///< absent: as in the graph
  std::string duration;               ///< "20s"; empty: as in the graph
  std::vector<std::string> settings;  ///< component.key=value
  std::size_t max_restarts = 5;  ///< of one component within 30 s; one more failure ends the run
  std::string ready_timeout = "60s";    ///< time limit until all components are ready
  std::string folder;                   ///< of the run; empty: erp_runs/<graph>/<UTC time>
  std::optional<std::string> security;  ///< folder of erp security make; absent: ERP_SECURITY
};

/// Starts, supervises and stops the graph. Returns the exit code of Run::execute.
/// Throws xml::Errors and std::invalid_argument for bad input, before any process is started.
int launch_graph(const LaunchOptions& options);

}  // namespace launch
