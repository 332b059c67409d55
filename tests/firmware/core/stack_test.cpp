// Largest stack depth of the firmware, from the compiler's call graph (gcc -fcallgraph-info=su).
#include <algorithm>
#include <catch2/catch.hpp>
#include <fstream>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <string>

namespace {

struct Graph {
  std::map<std::string, long> bytes;                     ///< stack frame of a function
  std::map<std::string, std::set<std::string>> callees;  ///< functions it may call
  std::set<std::string> unbounded;                       ///< functions with frames of unknown size
};

/// Static functions of two files may share a name: the compiler then prefixes the file.
void read(std::istream& text, Graph& graph) {
  static const std::regex node(R"re(node: \{ title: "([^"]+)".*\\n(\d+) bytes \((\w+)\))re"),
      edge(R"re(edge: \{ sourcename: "([^"]+)" targetname: "([^"]+)")re");
  std::smatch part;
  for (std::string line; std::getline(text, line);) {
    if (std::regex_search(line, part, node)) {
      graph.bytes[part[1]] = std::stol(part[2]);
      if (part[3] != "static") graph.unbounded.insert(part[1]);
    } else if (std::regex_search(line, part, edge)) {
      graph.callees[part[1]].insert(part[2]);
    }
  }
}

/// Stack depth of a function. `bytes` includes the return address on x86-64.
struct Depth {
  const Graph& graph;
  std::set<std::string> call_path = {};  ///< functions on the current call path
  std::set<std::string> unknown = {};    ///< called functions that are not part of the firmware
  std::optional<std::string> recursive = {};

  long of(const std::string& name) {
    if (!graph.bytes.contains(name)) {
      unknown.insert(name);
      return 0;
    }
    if (!call_path.insert(name).second) {
      recursive = name;
      return 0;
    }
    long deepest = 0;
    if (const auto calls = graph.callees.find(name); calls != graph.callees.end())
      for (const auto& callee : calls->second) deepest = std::max(deepest, of(callee));
    call_path.erase(name);
    return graph.bytes.at(name) + deepest;
  }
};

Graph firmware() {
  Graph graph;
  std::stringstream objects(ERP_FIRMWARE_OBJECTS);
  for (std::string object; std::getline(objects, object, ':');) {
    std::ifstream file(object.substr(0, object.size() - 1) + "ci");
    INFO(object);
    REQUIRE(file);
    read(file, graph);
  }
  return graph;
}

}  // namespace

TEST_CASE("the stack depth of the firmware is bounded: no recursion, no calls by pointer") {
  const Graph graph = firmware();
  REQUIRE(graph.bytes.contains("ecu_tick"));
  REQUIRE(graph.bytes.contains("ecu_link_pack"));
  CHECK(graph.unbounded.empty());
  for (const auto& [name, bytes] : graph.bytes) {
    Depth depth{graph};
    const long deepest = depth.of(name);
    INFO(name << " needs " << deepest << " bytes");
    CHECK(deepest <= 512);
    CHECK_FALSE(depth.recursive.has_value());
    for (const auto& callee : depth.unknown)
      CHECK((callee == "memcpy" || callee == "memset" || callee == "memmove"));
  }
}

TEST_CASE("recursion, frames of unknown size and calls out of the firmware are detected") {
  std::istringstream text(
      "node: { title: \"a\" label: \"a\\na.c:1:1\\n48 bytes (static)\" }\n"
      "node: { title: \"b\" label: \"b\\na.c:2:1\\n16 bytes (dynamic)\" }\n"
      "edge: { sourcename: \"a\" targetname: \"b\" label: \"a.c:3:1\" }\n"
      "edge: { sourcename: \"b\" targetname: \"a\" label: \"a.c:4:1\" }\n"
      "edge: { sourcename: \"b\" targetname: \"__indirect_call\" label: \"a.c:5:1\" }\n");
  Graph graph;
  read(text, graph);
  Depth depth{graph};
  CHECK(depth.of("a") == 64);
  CHECK(depth.recursive == "a");
  CHECK(graph.unbounded == std::set<std::string>{"b"});
  CHECK(depth.unknown == std::set<std::string>{"__indirect_call"});
}
