#pragma once
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "interfaces/graph/graph.hpp"
#include "launch/erp/run/bus_link.hpp"
#include "launch/erp/run/plan.hpp"
#include "launch/erp/run/process.hpp"
#include "launch/erp/run/processor_share.hpp"
#include "launch/erp/run/run_time.hpp"
#include "launch/erp/run/screen.hpp"
#include "launch/erp/run/signals.hpp"
#include "launch/erp/run/supervisor.hpp"

/// One run of a graph: the supervisor's wishes carried out with real processes, the bus, a clock
/// and a screen.
namespace launch {

class Run {
 public:
  Run(const erp::Graph& graph, const std::string& robot, Plan plan, const std::string& folder);

  /// Until the run has ended. Returns 0 when all ended well, 1 when a component failed for good,
  /// 2 when one could not use its input.
  int execute();
  double lasted_s() const { return time_.lasted_s(); }  ///< see RunTime

 private:
  /// What belongs to one planned process while it runs.
  struct Member {
    std::optional<Process> process;
    std::optional<erp::ComponentState> heard;
    std::int64_t heard_ns = 0;
    ProcessorShare share;
  };

  void wait();
  void hear_bus();
  void hear(const erp::ComponentState& state);
  bool finds_rival();
  void refuse_stranger(const erp::ComponentState& state);
  void hear(const erp::Event& event);
  void hear(const erp::Clock& clock);
  bool is_ending() const;
  void reap();
  void obey_signals();
  void end_when_due();
  void carry_out();
  void spawn(std::size_t index);
  void show_log(std::size_t index);
  void note(const std::string& text);  ///< to erp.log alone
  void say(const std::string& text);   ///< to erp.log and the screen
  void say_end();
  Row row(std::size_t index);
  std::string state_of(std::size_t index) const;
  Status status();

  const erp::Graph& graph_;
  Plan plan_;
  std::string folder_;
  std::ofstream log_;
  Signals signals_;  // before the bus, whose threads inherit the mask
  BusLink bus_;
  Supervisor supervisor_;
  RunTime time_;
  Screen screen_;
  std::vector<Member> members_;
  std::map<std::string, std::size_t> index_of_;
  std::int64_t drawn_ns_ = 0;
};

}  // namespace launch
