#pragma once
#include <poll.h>

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "components/node/clock.hpp"
#include "components/node/histogram.hpp"
#include "components/node/log_throttle.hpp"
#include "components/node/options.hpp"
#include "components/node/peers.hpp"
#include "components/node/port.hpp"
#include "components/node/real_time.hpp"
#include "components/node/timer.hpp"
#include "interfaces/values.hpp"

/// One process on the bus: its ports, its lifecycle, its heartbeat.
///
///   unconfigured --constructor--> inactive --activate--> active --finish--> finalized
///                                            <-deactivate-        any --throw--> error
///
/// Message handlers run on DDS's thread when their message arrives, or in the main loop if
/// registered with Where::in_loop. Timers, descriptor handlers and activation run inside `spin`. A
/// gate ensures that only one of them runs at a time. A handler must be short: while it runs, this
/// process receives nothing else.
namespace node {

class Node {
 public:
  /// `real_time`: runs at real-time priority if permitted (real_time.hpp), for components in the
  /// control loop.
  enum class Scheduling { normal, real_time };

  /// `role`: see Peer; default: the component's name.
  Node(Options options, std::string robot_name, Scheduling scheduling = Scheduling::real_time,
       const std::string& role = "");
  ~Node();
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  const Options& options() const { return options_; }
  Clock& clock() { return clock_; }
  const Entity& participant() const { return participant_; }  ///< for raw readers and discovery
  Wake& wake() { return wake_; }
  bool active() const { return active_; }

  template <class M>
  Publisher<M>& advertise() {
    const int depth = clock_.lockstep() ? lockstep_depth : 1;
    return add_port(std::make_unique<Publisher<M>>(participant_, identity_, depth));
  }
  /// `handler` is called only while the node is active.
  template <class M>
  Subscription<M>& subscribe(std::function<void(const M&)> handler,
                             int depth = erp::Topic<M>::depth, Where where = Where::on_arrival) {
    return add_port(std::make_unique<Subscription<M>>(participant_, wake_, gate_, active_, where,
                                                      depth, identity_, std::move(handler)));
  }
  /// Calls `callback` each period of real time while active. Timer defines the handling of
  /// overdue calls; skipped calls count as overruns.
  void every(std::int64_t period_ns, std::function<void()> callback, std::int64_t catch_up_ns = 0);
  /// Calls `callback` while active whenever the descriptor is readable.
  void watch(int descriptor, std::function<void()> callback);
  void on_activate(std::function<void()> callback) { activate_.push_back(std::move(callback)); }
  void on_deactivate(std::function<void()> callback) { deactivate_.push_back(std::move(callback)); }

  /// Counts one step for a message stamped `stamp_ns`; updates rate, age and jitter.
  void count_step(std::int64_t stamp_ns);
  /// Adds a named value to every heartbeat from now on. Throws std::length_error beyond 128 names,
  /// or for a name longer than 32 characters.
  void show(const std::string& name, double value);
  /// Writes a report to the log and publishes it on the `event` topic; LogThrottle limits repeats.
  void report(erp::Severity severity, const std::string& subject, const std::string& code,
              const std::string& text);
  /// Ends `spin` after the current handler; no other handler starts.
  void finish(int exit_code = 0);
  /// Runs until `finish`, SIGINT or SIGTERM. Returns the exit code of the process: 0; 1 when a
  /// handler threw; 2 when another process already has the component's name or role for this robot,
  /// because both would send commands.
  int spin();

 private:
  struct Periodic {
    Timer timer;
    std::function<void()> callback;
  };
  struct Watch {
    int descriptor;
    std::function<void()> callback;
  };

  template <class P>
  P& add_port(std::unique_ptr<P> port) {
    P& reference = *port;
    ports_.push_back(std::move(port));
    return reference;
  }
  Entity join_with_priority();
  bool uses_real_time() const;
  void set_lifecycle(erp::Lifecycle lifecycle);
  /// Sets the state and publishes it.
  void enter(erp::Lifecycle lifecycle);
  void on_lifecycle_command(const erp::LifecycleCommand& command);
  void activate();
  void deactivate();
  void run_timers();
  void wait();
  void serve();
  void heartbeat();
  void discover();
  void finish_as_duplicate_of(const Peer& running);

  Options options_;
  Scheduling scheduling_;
  Identity identity_;
  Clock clock_;
  int signals_;  ///< before the participant, whose threads inherit the signal mask
  Peer self_;
  Wake wake_;
  Entity participant_;
  Peers peers_;
  Gate gate_{wake_};
  std::vector<std::unique_ptr<Port>> ports_;
  std::vector<Periodic> periodics_;
  std::vector<Watch> watches_;
  std::vector<pollfd> polled_;  ///< wake, signals, then one per watch
  std::vector<std::function<void()>> activate_, deactivate_;
  Publisher<erp::ComponentState>* state_out_;
  Publisher<erp::Event>* event_out_;
  Subscription<erp::LifecycleCommand>* lifecycle_in_;
  erp::Lifecycle lifecycle_ = erp::Lifecycle::unconfigured;
  bool active_ = false;
  std::optional<std::int64_t> start_due_ns_;  ///< unmanaged: time of activation
  erp::ComponentState state_;
  Histogram age_, jitter_;
  LogThrottle throttle_;
  std::uint64_t steps_at_heartbeat_ = 0;
  std::int64_t heartbeat_due_ns_ = 0, last_heartbeat_ns_ = 0;
  std::int64_t last_step_ns_ = 0, last_interval_ns_ = 0;
  std::atomic<bool> finished_ = false;
  int exit_code_ = 0;
};

}  // namespace node
