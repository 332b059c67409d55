#pragma once
#include <optional>
#include <string>
#include <vector>

#include "interfaces/xml/fields.hpp"

/// A graph of components, as `erp launch` starts it.
namespace erp {

enum class Device { sim, can, replay };
enum class Time { realtime, lockstep, wall };
enum class Restart { never, on_failure, always };

/// One process of the graph.
struct GraphComponent {
  static constexpr auto element = "component";
  xml::Place place;
  std::string name;    ///< unique in the graph; also the topic key `component`
  std::string type;    ///< the program; absent: the same as `name`
  std::string config;  ///< its XML, relative to the graph file; absent: defaults
  Restart restart = Restart::on_failure;
  void visit(auto& v) {
    v.required("name", name);
    v("type", type);
    v("config", config);
    v("restart", restart);
  }
};

/// The simulator, the plant and the device come with every graph and need no line, unless they
/// want a config of their own.
struct Graph {
  static constexpr auto element = "graph";
  xml::Place place;
  std::string name;
  std::string robot;  ///< robot.xml, relative to the graph file
  Device device = Device::sim;
  std::string replay;                          ///< the recording, for device="replay"
  std::string bus = "udp:239.255.42.1:20000";  ///< for device="can"
  bool hardware = false;                       ///< true: no simulated robot behind the bus
  Time time = Time::realtime;
  double duration_s = 0;  ///< 0: until interrupted
  std::vector<GraphComponent> components;
  void visit(auto& v) {
    v.required("name", name);
    v.required("robot", robot);
    v("device", device);
    v("replay", replay);
    v("bus", bus);
    v("hardware", hardware);
    v("time", time);
    v("duration_s", duration_s, xml::at_least_zero);
    v.list(components);
  }
};

/// Reads a graph; file names come back resolved against the graph's folder. Throws xml::Errors.
Graph read_graph(const std::string& file);

}  // namespace erp

template <>
struct xml::Names<erp::Device> {
  static constexpr auto list = std::to_array<std::pair<const char*, erp::Device>>(
      {{"sim", erp::Device::sim}, {"can", erp::Device::can}, {"replay", erp::Device::replay}});
};
template <>
struct xml::Names<erp::Time> {
  static constexpr auto list =
      std::to_array<std::pair<const char*, erp::Time>>({{"realtime", erp::Time::realtime},
                                                        {"lockstep", erp::Time::lockstep},
                                                        {"wall", erp::Time::wall}});
};
template <>
struct xml::Names<erp::Restart> {
  static constexpr auto list =
      std::to_array<std::pair<const char*, erp::Restart>>({{"never", erp::Restart::never},
                                                           {"on-failure", erp::Restart::on_failure},
                                                           {"always", erp::Restart::always}});
};
