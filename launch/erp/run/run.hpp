#pragma once
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "interfaces/graph/graph.hpp"
#include "launch/erp/run/bus_link.hpp"
#include "launch/erp/run/frame_watch.hpp"
#include "launch/erp/run/input_files.hpp"
#include "launch/erp/run/plan.hpp"
#include "launch/erp/run/process.hpp"
#include "launch/erp/run/processor_share.hpp"
#include "launch/erp/run/renewal.hpp"
#include "launch/erp/run/run_time.hpp"
#include "launch/erp/run/screen.hpp"
#include "launch/erp/run/signals.hpp"
#include "launch/erp/run/supervisor.hpp"

/// One run of a graph: executes the actions of the supervisor with processes, bus, clock and
/// screen.
namespace launch {

class Run {
 public:
  Run(const erp::Graph& graph, const std::string& robot, Plan plan, const std::string& folder);

  /// Returns after the end of the run: 0 all processes ended normally, 1 a component failed
  /// permanently or was killed, 2 bad input or a conflicting graph.
  int execute();
  double active_s() const { return time_.active_s(); }  ///< see RunTime

 private:
  /// State of one planned process during the run.
  struct Member {
    std::optional<Process> process;
    std::optional<erp::ComponentState> heartbeat;
    std::int64_t heartbeat_ns = 0;
    ProcessorShare share;
  };

  void wait();
  void poll_bus();
  void on_state(const erp::ComponentState& state);
  bool finds_conflict();
  void reject_conflict(const erp::ComponentState& state);
  void on_event(const erp::Event& event);
  void on_clock(const erp::Clock& clock);
  bool is_ending() const;
  /// Reports that frames stop while all processes run, and that they resume.
  void watch_frames();
  void renew_if_stopped();
  /// Runs the command of the plan each time all components have become active.
  void run_when_active();
  bool is_any_suspended() const;
  bool is_bus_disturbed() const;
  std::uint64_t device_steps() const;
  void reap();
  void handle_signals();
  void stop_after_duration();
  void execute_actions();
  void spawn(std::size_t index);
  void show_log(std::size_t index);
  void log(const std::string& text);    ///< to erp.log only
  void print(const std::string& text);  ///< to erp.log and the screen
  void print_end();
  Row row(std::size_t index);
  std::string state_of(std::size_t index) const;
  Status status();

  static constexpr std::size_t max_log_lines = 12;  ///< printed at once; chosen

  const erp::Graph& graph_;
  Plan plan_;
  InputFiles inputs_;
  std::string folder_;
  std::ofstream log_;
  Signals signals_;  // before bus_: its threads inherit the signal mask
  BusLink bus_;
  Supervisor supervisor_;
  RunTime time_;
  Screen screen_;
  std::vector<Member> members_;
  std::map<std::string, std::size_t> index_of_;
  FrameWatch frame_watch_;
  Renewal renewal_;
  std::optional<Process> when_active_;
  bool was_running_ = false;
  bool has_silent_member_ = false;  ///< no heartbeat from at least one process
  std::uint64_t device_steps_ = 0;  ///< when frames stopped
  std::int64_t last_drawn_ns_ = 0;
};

}  // namespace launch
