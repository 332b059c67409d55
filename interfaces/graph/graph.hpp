#pragma once
#include <optional>
#include <string>
#include <vector>

#include "interfaces/xml/fields.hpp"

/// A graph of components that `erp launch` starts.
namespace erp {

enum class Device { sim, can, replay };
enum class Time { realtime, lockstep, wall };
enum class Restart { never, on_failure, always };

struct GraphComponent {
  static constexpr auto element = "component";
  static constexpr auto description =
      "Process of the graph. The plant, the device (sim, gateway or replay) and the simulator "
      "behind a bus are started without a <component>; they need one only for a config of their "
      "own.";
  xml::Place place;
  std::string name;
  std::string type;    ///< empty: the same as `name`
  std::string config;  ///< empty: default parameters
  Restart restart = Restart::on_failure;
  void visit(auto& v) {
    v.required("name", name,
               "Name, unique in the graph, at most 32 characters; key of its messages on the bus.");
    v("type", type, "Program, or path of a program. Default: the program named as name.");
    v("config", config,
      "XML file with its parameters, relative to the graph file; its root element is named as the "
      "type. Default: default parameters.");
    v("restart", restart,
      "When the process is restarted: never, after an exit with failure, or after every exit. With "
      "never, a failure stops the graph; rejected input (exit code 2) always stops it.");
  }
};

struct Graph {
  static constexpr auto element = "graph";
  static constexpr auto description = "Graph of processes for one robot, started by `erp launch`.";
  xml::Place place;
  std::string name;
  std::string robot;
  Device device = Device::sim;
  std::string replay;
  std::string bus = "udp:239.255.42.1:20000";
  bool hardware = false;
  Time time = Time::realtime;
  double duration_s = 0;  ///< 0: until interrupted
  std::vector<GraphComponent> components;
  void visit(auto& v) {
    v.required("name", name, "Name of the graph; names the folder of a run and its recording.");
    v.required("robot", robot, "robot.xml, relative to the graph file.");
    v("device", device,
      "Component in the place of the robot: sim, the simulator; can, the CAN buses of ECUs; "
      "replay, a recording. `--device` overrides it.");
    v("replay", replay, "Recording (.mcap) for device=replay, relative to the graph file.");
    v("bus", bus,
      "CAN bus for device=can: socketcan:INTERFACE, or udp:GROUP:PORT for a bus of processes over "
      "multicast. For several buses, list all, separated by spaces, or give the first one; its "
      "number is counted up. Default: port 20000 + 16 ERP_DOMAIN.");
    v("hardware", hardware,
      "For device=can: true if the ECUs of a real robot are on the bus; false starts the simulator "
      "behind the bus. Excludes lockstep.");
    v("time", time,
      "realtime and wall, which do not differ: by the clock of the computer; lockstep: each "
      "process waits for the messages of its cycle, so that runs are repeatable.");
    v("duration_s", duration_s,
      {xml::at_least_zero,
       "Duration of the run, in device time in lockstep, otherwise in real time. 0: until "
       "interrupted. `--for` overrides it."});
    v.list(components);
  }
};

/// Reads a graph; resolves file names relative to the graph's folder. Throws xml::Errors.
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
