#pragma once
#include <iosfwd>
#include <string>
#include <vector>

#include "components/node/raw.hpp"

/// Views of the running graph.
namespace launch {

int show_components(std::ostream& out);       ///< `erp ps`
int show_topics(std::ostream& out);           ///< `erp ls`
int show_graph(bool all, std::ostream& out);  ///< `erp graph`: DOT

/// Components and topics in DOT. Without `all`, omits the topics of every component
/// (component_state, lifecycle_command, event) and the tools of `erp`. Does not use the bus.
std::string to_dot(const std::vector<node::Endpoint>& endpoints, bool all);
/// One line per topic: type, writers, readers. Does not use the bus.
std::vector<std::string> topic_table(const std::vector<node::Endpoint>& endpoints);

}  // namespace launch
