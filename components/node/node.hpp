#pragma once
#include <poll.h>

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "components/node/clock.hpp"
#include "components/node/damper.hpp"
#include "components/node/histogram.hpp"
#include "components/node/options.hpp"
#include "components/node/peers.hpp"
#include "components/node/port.hpp"
#include "components/node/real_time.hpp"
#include "components/node/timer.hpp"
#include "interfaces/values.hpp"

/// One process on the bus: its ports, its life, its heartbeat.
///
///   unconfigured --constructor--> inactive --activate--> active --finish--> finalized
///                                            <-deactivate-        any --throw--> error
///
/// One at a time: handlers run on DDS's thread where their message arrives (or in the loop, if they
/// ask for it), timers, descriptors and activation inside `spin`; a gate keeps them apart. A
/// handler must be short: while it runs, nothing else of this process is heard.
namespace node {

class Node {
 public:
  /// Whether a robot waits for it: it then runs at real-time priority where it may (real_time.hpp).
  enum class Urgency { usual, real_time };

  Node(Options options, std::string robot_name, Urgency urgency = Urgency::real_time);
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
    return own(std::make_unique<Publisher<M>>(participant_, identity_));
  }
  /// Handlers are called only while active.
  template <class M>
  Subscription<M>& subscribe(std::function<void(const M&)> use, int depth = 1,
                             Where where = Where::on_arrival) {
    return own(std::make_unique<Subscription<M>>(participant_, wake_, gate_, active_, where, depth,
                                                 identity_, std::move(use)));
  }
  /// Calls `act` each period of real time while active; late calls as in Timer, those left out
  /// count as overruns.
  void every(std::int64_t period_ns, std::function<void()> act, std::int64_t make_up_ns = 0);
  /// Calls `act` while active whenever the descriptor has something to read.
  void watch(int descriptor, std::function<void()> act);
  void on_activate(std::function<void()> act) { activate_.push_back(std::move(act)); }
  void on_deactivate(std::function<void()> act) { deactivate_.push_back(std::move(act)); }

  /// Counts one step answering a message stamped `stamp_ns`: rate, age, jitter.
  void count_step(std::int64_t stamp_ns);
  /// A figure of this component's own, in every heartbeat from now on. Throws std::length_error
  /// beyond 128 names, or for one longer than 32 characters.
  void show(const std::string& name, double value);
  /// Says a thing once, to the log and on the `event` topic.
  void report(erp::Severity severity, const std::string& subject, const std::string& code,
              const std::string& text);
  /// Ends `spin` after the current handler; no other handler begins.
  void finish(int exit_code = 0);
  /// Runs until finished, SIGINT or SIGTERM. Returns the process's exit code: 0; 1 when a handler
  /// threw; 2 when a namesake was on the bus before us, because two of one part would both drive.
  int spin();

 private:
  struct Periodic {
    Timer timer;
    std::function<void()> act;
  };
  struct Watch {
    int descriptor;
    std::function<void()> act;
  };

  template <class P>
  P& own(std::unique_ptr<P> port) {
    P& lent = *port;
    ports_.push_back(std::move(port));
    return lent;
  }
  Entity join_in_time();
  bool in_real_time() const;
  void set_lifecycle(erp::Lifecycle lifecycle);
  /// Sets it and tells everyone.
  void enter(erp::Lifecycle lifecycle);
  void obey(const erp::LifecycleCommand& command);
  void activate();
  void deactivate();
  void run_timers();
  void wait();
  void serve();
  void heartbeat();
  void look_around();
  void leave_to(const Peer& predecessor);

  Options options_;
  Urgency urgency_;
  Identity identity_;
  Clock clock_;
  int signals_;  // before the participant, whose threads inherit the mask
  Peer self_;
  Wake wake_;
  Entity participant_;
  Peers peers_;
  Gate gate_{wake_};
  std::vector<std::unique_ptr<Port>> ports_;
  std::vector<Periodic> periodics_;
  std::vector<Watch> watches_;
  std::vector<pollfd> polled_;  ///< wake, signals, then one a watch
  std::vector<std::function<void()>> activate_, deactivate_;
  Publisher<erp::ComponentState>* state_out_;
  Publisher<erp::Event>* event_out_;
  Subscription<erp::LifecycleCommand>* lifecycle_in_;
  erp::Lifecycle lifecycle_ = erp::Lifecycle::unconfigured;
  bool active_ = false;
  std::optional<std::int64_t> start_due_ns_;  ///< unmanaged: when to become active by itself
  erp::ComponentState state_;
  Histogram age_, jitter_;
  Damper damper_;
  std::uint64_t steps_at_heartbeat_ = 0;
  std::int64_t heartbeat_due_ns_ = 0, heartbeat_last_ns_ = 0;
  std::int64_t last_step_ns_ = 0, last_interval_ns_ = 0;
  std::atomic<bool> finished_ = false;
  int exit_code_ = 0;
};

}  // namespace node
