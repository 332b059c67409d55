#pragma once
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "interfaces/graph/graph.hpp"
#include "interfaces/values.hpp"
#include "launch/erp/run/back_off.hpp"
#include "launch/erp/run/process.hpp"

/// The life cycle of a graph as a state machine without side effects: inputs are events and time,
/// outputs are actions.
///
///   starting ──all ready──▶ activating ──all active──▶ running ──stop──▶ stopping ──▶ done
///
/// A component is ready when it is inactive, has discovered every other process and the launcher,
/// and its links have not changed for `settle_ns`. Members are activated in the given order and
/// stopped in reverse order. Each is stopped after the preceding one has reported `finalized` or
/// has ended.
namespace launch {

/// Exit code of a component that rejects its input. It is not restarted.
inline constexpr int bad_input = 2;

/// A process under supervision.
struct SupervisedProcess {
  std::string name;
  erp::Restart restart = erp::Restart::on_failure;
  bool ends_run = false;  ///< a device: the run ends when it exits with 0
};

/// State of a component from its message on `component_state`.
struct Heartbeat {
  erp::Lifecycle lifecycle = erp::Lifecycle::unconfigured;
  std::uint32_t peers = 0, links = 0;
};

/// All values are chosen.
struct Tuning {
  std::int64_t settle_ns =
      200'000'000;  ///< time without a change of links before a component is ready
  std::int64_t resend_ns = 200'000'000;  ///< time until an activation without effect is sent again
  std::int64_t start_timeout_ns = 60'000'000'000;
  std::int64_t stop_timeout_ns = 5'000'000'000;  ///< from SIGTERM to SIGKILL
  std::int64_t renew_timeout_ns = 500'000'000;   ///< the same in `renew`
  BackOff::Tuning restart;
};

enum class Phase { waiting, starting, inactive, active, backing_off, stopping, ended, failed };
enum class Stage { starting, activating, running, stopping, done };
const char* name_of(Phase phase);
const char* name_of(Stage stage);

struct Action {
  enum class Kind { spawn, activate, terminate, kill, print, show_log };
  Kind kind;
  std::size_t member = 0;
  std::string text;  ///< for `print`
};

class Supervisor {
 public:
  explicit Supervisor(std::vector<SupervisedProcess> processes, Tuning tuning = {});

  void start(std::int64_t now_ns);
  void tick(std::int64_t now_ns);
  void on_heartbeat(std::size_t member, const Heartbeat& heartbeat, std::int64_t now_ns);
  void on_exit(std::size_t member, const Ending& ending, std::int64_t now_ns);
  /// Stops the run in order. `exit_code` is 0 at the user's request. Of several calls, the largest
  /// code applies.
  void stop(const std::string& reason, int exit_code, std::int64_t now_ns);
  void kill_now();
  /// Ends all processes and starts the graph again in order, although no process has failed: the bus
  /// is disturbed. Counts as a restart of each, but not towards its limit.
  void renew(std::int64_t now_ns);

  std::vector<Action> take_actions();
  Stage stage() const { return stage_; }
  bool done() const { return stage_ == Stage::done; }
  int exit_code() const { return exit_code_; }
  Phase phase(std::size_t member) const { return members_[member].phase; }
  std::size_t restarts(std::size_t member) const { return members_[member].restarts; }

 private:
  struct Member {
    SupervisedProcess process;
    BackOff back_off;
    Phase phase = Phase::waiting;
    Heartbeat heartbeat;
    std::int64_t links_changed_ns = 0;         ///< when the links last changed
    std::optional<std::int64_t> requested_ns;  ///< time of the last request to activate or to end
    std::int64_t spawn_due_ns = 0;
    bool killed = false;
    bool renewed = false;    ///< ends because of `renew`
    bool finalized = false;  ///< has reported `finalized`; only its process still has to end
    std::size_t restarts = 0;
  };

  bool is_alive(const Member& member) const;
  bool is_ready(const Member& member, std::int64_t now_ns) const;
  void spawn_due(std::int64_t now_ns);
  void await_all(std::int64_t now_ns);
  void activate_next(std::int64_t now_ns);
  void stop_next(std::int64_t now_ns);
  void kill_if_overdue(Member& member, std::int64_t timeout_ns, std::int64_t now_ns);
  void restart(std::size_t index, const Ending& ending, std::int64_t now_ns);
  void fail(std::size_t index, const std::string& reason, int exit_code, std::int64_t now_ns);
  void add_action(Action::Kind kind, std::size_t index = 0, std::string text = "");
  void print(const std::string& text) { add_action(Action::Kind::print, 0, text); }
  std::size_t index_of(const Member& member) const {
    return static_cast<std::size_t>(&member - members_.data());
  }

  std::vector<Member> members_;
  Tuning tuning_;
  Stage stage_ = Stage::starting;
  std::int64_t started_ns_ = 0;
  int exit_code_ = 0;
  std::vector<Action> actions_;
};

}  // namespace launch
