#pragma once
#include <map>
#include <memory>
#include <string>

#include "components/node/node.hpp"
#include "components/node/raw.hpp"
#include "interfaces/recording/recorder.hpp"
#include "interfaces/recording/type_description.hpp"
#include "interfaces/robot/robot.hpp"

/// Records every topic of the bus to one MCAP file. Messages that name another robot are skipped.
namespace logger {

/// The IDL source of a message type such as "erp/msg/SensorFrame"; "" for types of other projects.
std::string idl_text(const std::string& message);

class LoggerNode {
 public:
  static constexpr bool in_background = true;
  struct Params {
    std::string file = "recording.mcap";
    std::string attach;
    void visit(auto& v) {
      v("file", file, "Recording to write, MCAP.");
      v("attach", attach, "XML files to keep with the recording, separated by colons.");
    }
  };
  LoggerNode(const Params& params, const erp::Robot& robot, node::Node& node);
  ~LoggerNode();

 private:
  struct Topic {
    std::size_t handle;
    recording::TypeDescription type;
    std::unique_ptr<node::RawReader> reader;
    node::Descriptor descriptor;  ///< type discovered on the bus; null for known types
  };
  void add(const std::string& topic, const dds_topic_descriptor_t& type,
           node::Descriptor descriptor);
  template <class M>
  void add_known();
  void discover();
  void take_all();
  void write(Topic& topic, const node::RawSample& sample);
  void report_disk();
  void check_space();
  std::int64_t log_time_ns() const;
  void close();

  node::Node& node_;
  std::string robot_;  ///< empty: record every robot
  recording::Recorder recorder_;
  node::Discovery discovery_;
  std::map<std::string, Topic> topics_;
  std::map<std::string, int>
      unrecordable_;  ///< topics whose type cannot be recorded; reported once
  std::int64_t started_wall_ns_ = node::wall_ns(), started_ns_ = node::monotonic_ns();
  std::uint64_t missing_reported_ = 0;
  bool is_failing_ = false;  ///< the last write failed
  std::uint64_t lost_reported_ = 0;
  std::int64_t space_checked_ns_ = 0;
  std::uint64_t bytes_at_check_ = 0;
  bool is_space_reported_ = false;
  bool closed_ = false;
};

}  // namespace logger
