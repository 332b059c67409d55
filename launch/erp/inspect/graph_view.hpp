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

/// Components and topics in DOT. Without `all`, the topics that every component has
/// (component_state, lifecycle_command, event) and the tools of `erp` are omitted. Pure.
std::string to_dot(const std::vector<node::Endpoint>& endpoints, bool all);
/// One line per topic: type, writers, readers. Pure.
std::vector<std::string> topic_table(const std::vector<node::Endpoint>& endpoints);

}  // namespace launch
