#pragma once
#include <optional>
#include <string>
#include <vector>

#include "interfaces/graph/graph.hpp"

/// `erp launch GRAPH.xml`.
namespace launch {

struct LaunchOptions {
  std::string graph_file;
  std::string device;                   ///< sim, can, replay:FILE; empty: the graph's
  std::optional<erp::Time> time;        ///< absent: the graph's
  std::string duration;                 ///< "20s"; empty: the graph's
  std::vector<std::string> settings;    ///< component.key=value
  std::size_t most_restarts = 5;        ///< of one component within 30 s; then it is given up
  std::string patience = "60s";         ///< until all components are ready; then it is given up
  std::string folder;                   ///< of the run; empty: erp_runs/<graph>/<UTC time>
  std::optional<std::string> security;  ///< folder of erp security make; absent: ERP_SECURITY's
};

/// Starts the graph, looks after it, ends it. Returns the exit code of Run::execute.
/// Throws xml::Errors and std::invalid_argument for bad input, before any process is started.
int launch_graph(const LaunchOptions& options);

}  // namespace launch
