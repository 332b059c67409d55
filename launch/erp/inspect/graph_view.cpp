#include "launch/erp/inspect/graph_view.hpp"

#include <iostream>
#include <map>
#include <ostream>
#include <set>

#include "components/node/clock.hpp"
#include "components/node/peers.hpp"
#include "interfaces/xml/words.hpp"
#include "launch/erp/inspect/discovery_listener.hpp"
#include "launch/erp/inspect/value_names.hpp"
#include "launch/erp/run/component_row.hpp"
#include "launch/erp/run/processor_share.hpp"
#include "launch/erp/text/columns.hpp"

namespace launch {
namespace {

using NameSet = std::set<std::string>;

constexpr auto empty_hint = "; start a graph, or set ERP_DOMAIN to the domain of its launcher\n";

constexpr std::int64_t heartbeat_wait_ns = 700'000'000;  // seven heartbeats after discovery

std::string name_of(const node::Endpoint& endpoint) {
  return endpoint.component.empty() ? "?" : endpoint.component;
}

std::string joined(const NameSet& names) {
  return names.empty() ? "-" : xml::joined({names.begin(), names.end()});
}

bool is_internal(const node::Endpoint& endpoint) {
  static const NameSet topics{"component_state", "lifecycle_command", "event"};
  return topics.contains(endpoint.topic) || endpoint.component == "erp" ||
         endpoint.component.starts_with("erp ");
}

std::string dot_name(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) (c == '"' || c == '\\' ? quoted += '\\' : quoted) += c;
  return quoted + "\"";
}

}  // namespace

std::vector<std::string> topic_table(const std::vector<node::Endpoint>& endpoints) {
  struct Topic {
    NameSet types, writers, readers;
  };
  std::map<std::string, Topic> topics;
  for (const auto& endpoint : endpoints) {
    Topic& topic = topics[endpoint.topic];
    topic.types.insert(endpoint.type);
    (endpoint.writer ? topic.writers : topic.readers).insert(name_of(endpoint));
  }
  std::vector<std::vector<std::string>> cells{{"topic", "type", "writers", "readers"}};
  for (const auto& [name, topic] : topics)
    cells.push_back({name, joined(topic.types), joined(topic.writers), joined(topic.readers)});
  return align(cells, {false, false, false, false});
}

std::string to_dot(const std::vector<node::Endpoint>& endpoints, bool all) {
  NameSet components, topics, edges;
  for (const auto& endpoint : endpoints) {
    if (!all && is_internal(endpoint)) continue;
    const std::string component = dot_name(name_of(endpoint));
    const std::string topic = dot_name("/" + endpoint.topic);
    components.insert(component);
    topics.insert(topic + " [label=" + dot_name(endpoint.topic) + "]");
    edges.insert(endpoint.writer ? component + " -> " + topic : topic + " -> " + component);
  }
  std::string dot = "digraph erp {\n  rankdir=LR;\n  node [fontname=\"sans-serif\"];\n";
  dot += "  node [shape=box, style=filled, fillcolor=\"#dce9f5\"];\n";
  for (const auto& component : components) dot += "  " + component + ";\n";
  dot += "  node [shape=ellipse, style=solid];\n";
  for (const auto& topic : topics) dot += "  " + topic + ";\n";
  for (const auto& edge : edges) dot += "  " + edge + ";\n";
  return dot + "}\n";
}

int show_components(std::ostream& out) {
  DiscoveryListener discovery("ps");
  node::Reader<erp::ComponentState> states(discovery.participant(), discovery.wake());
  std::map<std::string, std::map<std::string, Row>> robots;
  std::map<pid_t, ProcessorShare> shares;
  const auto take_states = [&] {
    states.take([&](const erp::ComponentState& state) {
      Row& row = robots[state.robot][state.component];
      row.name = state.component;
      row.state = value_name("erp/msg/ComponentState", "lifecycle", state.lifecycle);
      row.cpu_percent = shares[state.pid].measure(state.pid, node::monotonic_ns());
      fill_measurements(row, state);
    });
    return false;
  };
  if (!discovery.watch(node::discovery_ns() + heartbeat_wait_ns, take_states)) return 1;
  if (robots.empty()) out << "the bus has no component" << empty_hint;
  for (const auto& [robot, components] : robots) {
    out << "robot " << (robot.empty() ? "-" : robot) << '\n';
    std::vector<Row> rows;
    for (const auto& [name, row] : components) rows.push_back(row);
    for (const auto& line : render_rows(rows)) out << line << '\n';
  }
  return 0;
}

int show_topics(std::ostream& out) {
  DiscoveryListener discovery("ls");
  if (!discovery.settle()) return 1;
  const auto endpoints = discovery.endpoints();
  if (endpoints.empty()) out << "the bus has no topic" << empty_hint;
  else
    for (const auto& line : topic_table(endpoints)) out << line << '\n';
  return 0;
}

int show_graph(bool all, std::ostream& out) {
  DiscoveryListener discovery("graph");
  if (!discovery.settle()) return 1;
  const auto endpoints = discovery.endpoints();
  if (endpoints.empty()) std::cerr << "the bus is empty" << empty_hint;
  out << to_dot(endpoints, all);
  return 0;
}

}  // namespace launch
