#include "components/node/node.hpp"

#include <spdlog/spdlog.h>
#include <sys/prctl.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>

namespace node {
namespace {

constexpr std::int64_t heartbeat_ns = 100'000'000;
constexpr unsigned long timer_slack_ns = 1000;
constexpr std::size_t first_watch = 2;  // polled_ starts with the wake and the signals

/// Makes SIGINT and SIGTERM readable on a descriptor and reduces the timer slack from 50 µs to 1
/// µs. Must run before DDS starts its threads, which inherit both settings.
int prepare_process() {
  prctl(PR_SET_TIMERSLACK, timer_slack_ns);
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  return signalfd(-1, &set, SFD_CLOEXEC | SFD_NONBLOCK);
}

spdlog::level::level_enum level_of(erp::Severity severity) {
  switch (severity) {
    case erp::Severity::info:
      return spdlog::level::info;
    case erp::Severity::warning:
      return spdlog::level::warn;
    case erp::Severity::fault:
      break;
  }
  return spdlog::level::err;
}

}  // namespace

Node::Node(Options options, std::string robot_name, Scheduling scheduling, const std::string& role)
    : options_(std::move(options)),
      scheduling_(scheduling),
      identity_{std::move(robot_name), options_.name, options_.priority},
      clock_(options_.time),
      signals_(prepare_process()),
      self_(own_peer(options_.name, identity_.robot, role)),
      participant_(join_with_priority()),
      peers_(participant_, wake_, self_),
      polled_{{wake_.descriptor(), POLLIN, 0}, {signals_, POLLIN, 0}} {
  if (!options_.managed) start_due_ns_ = monotonic_ns() + discovery_ns();
  state_out_ = &advertise<erp::ComponentState>();
  event_out_ = &advertise<erp::Event>();
  lifecycle_in_ = &subscribe<erp::LifecycleCommand>(
      [this](const erp::LifecycleCommand& command) { on_lifecycle_command(command); },
      erp::Topic<erp::LifecycleCommand>::depth, Where::in_loop);
  state_.pid = getpid();
}

/// DDS's threads inherit the priority of the thread that starts them.
Entity Node::join_with_priority() {
  const RealTimePriority priority(uses_real_time());
  return join(self_);
}

bool Node::uses_real_time() const {
  return scheduling_ == Scheduling::real_time && !clock_.lockstep();
}

Node::~Node() {
  gate_.close();
  close(signals_);
}

void Node::every(std::int64_t period_ns, std::function<void()> callback, std::int64_t catch_up_ns) {
  periodics_.push_back({{period_ns, catch_up_ns, monotonic_ns()}, std::move(callback)});
}

void Node::watch(int descriptor, std::function<void()> callback) {
  watches_.push_back({descriptor, std::move(callback)});
  polled_.push_back({descriptor, POLLIN, 0});
}

void Node::set_lifecycle(erp::Lifecycle lifecycle) {
  lifecycle_ = lifecycle;
  active_ = lifecycle == erp::Lifecycle::active;
  peers_.set_active(active_);
}

void Node::enter(erp::Lifecycle lifecycle) {
  set_lifecycle(lifecycle);
  heartbeat();
}

void Node::on_lifecycle_command(const erp::LifecycleCommand& command) {
  if (identity_.component != command.component) return;
  const auto target = static_cast<erp::Lifecycle>(command.target);
  if (target == erp::Lifecycle::finalized) return finish();
  if (target == erp::Lifecycle::active && !active()) activate();
  if (target == erp::Lifecycle::inactive && active()) deactivate();
}

void Node::activate() {
  discover();
  if (finished_) return;
  const auto now_ns = monotonic_ns();
  for (auto& periodic : periodics_) periodic.timer.restart(now_ns);
  for (const auto& port : ports_) port->poll(false);  // drops messages that arrived while inactive
  set_lifecycle(erp::Lifecycle::active);
  for (auto& callback : activate_) callback();
  heartbeat();  // reports "active" only after all activation callbacks
}

void Node::deactivate() {
  for (auto& callback : deactivate_) callback();
  enter(erp::Lifecycle::inactive);
}

void Node::count_step(std::int64_t stamp_ns) {
  const auto now_ns = monotonic_ns();
  ++state_.steps;
  age_.add_ns(clock_.stamp_ns() - stamp_ns);
  const auto interval_ns = now_ns - last_step_ns_;
  if (last_step_ns_ && last_interval_ns_) jitter_.add_ns(std::abs(interval_ns - last_interval_ns_));
  last_interval_ns_ = last_step_ns_ ? interval_ns : 0;
  last_step_ns_ = now_ns;
}

void Node::show(const std::string& name, double value) {
  const auto has_name = [&](const erp::ComponentValue& v) { return name == v.name; };
  const auto existing = std::ranges::find_if(erp::samples(state_.values), has_name);
  if (existing != erp::samples(state_.values).end()) {
    existing->value = value;
    return;
  }
  erp::ComponentValue added{};
  erp::assign(added.name, name);
  added.value = value;
  erp::append(state_.values, added);
}

void Node::report(erp::Severity severity, const std::string& subject, const std::string& code,
                  const std::string& text) {
  const auto suppressed = throttle_.admit(subject + ' ' + code, clock_.elapsed_ns());
  if (!suppressed) return;
  const std::string message =
      *suppressed ? text + " (" + std::to_string(*suppressed) + " repeats suppressed)" : text;
  spdlog::log(level_of(severity), "{}{}{}: {}", subject, subject.empty() ? "" : " ", code, message);
  erp::Event event;
  event.stamp_ns = clock_.stamp_ns();
  event.severity = static_cast<std::uint8_t>(severity);
  erp::assign_shortened(event.subject, subject);
  erp::assign_shortened(event.code, code);
  erp::assign_shortened(event.text, message);
  event_out_->publish(event);
  erp::assign_shortened(state_.note, message);
}

void Node::finish(int exit_code) {
  gate_.close();
  exit_code_ = std::max(exit_code_, exit_code);
  finished_ = true;
  wake_.raise();
}

void Node::discover() {
  peers_.discover();
  state_.peers = peers_.count();
  if (const auto& running = peers_.running_duplicate(); running && !finished_)
    finish_as_duplicate_of(*running);
  if (const auto& other = peers_.other_duplicate(); other && active())
    report(erp::Severity::warning, other->component, "duplicate",
           "pid " + std::to_string(other->pid) + " on " + other->host +
               " also claims to be the robot's " + self_.role + "; this process continues");
}

void Node::finish_as_duplicate_of(const Peer& running) {
  const bool has_our_name = running.component == identity_.component;
  // Not published as an event, because the event would name the running process as its source.
  spdlog::error(
      "pid {} on {} already runs as {} \"{}\" of robot \"{}\"; end it{}, or set ERP_DOMAIN to an "
      "unused number",
      running.pid, running.host, has_our_name ? "component" : self_.role, running.component,
      identity_.robot, self_.role == identity_.component ? ", choose another --name" : "");
  finish(2);
}

void Node::heartbeat() {
  const auto now_ns = monotonic_ns();
  state_.lifecycle = static_cast<std::uint8_t>(lifecycle_);
  state_.stamp_ns = clock_.stamp_ns();
  state_.links = 0, state_.missed = 0;
  for (const auto& port : ports_) state_.links += port->matched(), state_.missed += port->missed();
  discover();
  if (last_heartbeat_ns_ && now_ns - last_heartbeat_ns_ > heartbeat_ns / 2) {
    state_.rate_Hz = 1e9 * static_cast<double>(state_.steps - steps_at_heartbeat_) /
                     static_cast<double>(now_ns - last_heartbeat_ns_);
    last_heartbeat_ns_ = now_ns, steps_at_heartbeat_ = state_.steps;
  }
  if (!last_heartbeat_ns_) last_heartbeat_ns_ = now_ns;
  std::copy(age_.counts().begin(), age_.counts().end(), state_.age_bins);
  std::copy(jitter_.counts().begin(), jitter_.counts().end(), state_.jitter_bins);
  state_out_->publish(state_);
  heartbeat_due_ns_ = now_ns + heartbeat_ns;
}

void Node::run_timers() {
  const auto now_ns = monotonic_ns();
  if (now_ns >= heartbeat_due_ns_) heartbeat();
  if (start_due_ns_ && now_ns >= *start_due_ns_) start_due_ns_.reset(), activate();
  if (!active()) return;
  for (auto& periodic : periodics_) {
    if (now_ns < periodic.timer.next_ns()) continue;
    state_.overruns += static_cast<std::uint64_t>(periodic.timer.take(now_ns));
    periodic.callback();
  }
}

void Node::wait() {
  std::int64_t due_ns = std::min(heartbeat_due_ns_, start_due_ns_.value_or(heartbeat_due_ns_));
  if (active())
    for (const auto& periodic : periodics_) due_ns = std::min(due_ns, periodic.timer.next_ns());
  const auto remaining_ns = std::max<std::int64_t>(0, due_ns - monotonic_ns());
  const timespec timeout{remaining_ns / 1'000'000'000, remaining_ns % 1'000'000'000};
  const auto n = active() ? polled_.size() : polled_.size() - watches_.size();
  for (auto& entry : polled_) entry.revents = 0;
  ppoll(polled_.data(), n, &timeout, nullptr);
  if (polled_[0].revents) wake_.clear();
  if (polled_[1].revents) finish();
}

void Node::serve() {
  const auto lock = gate_.lock();
  gate_.rethrow();
  if (finished_) return;
  for (std::size_t i = 0; i < watches_.size(); ++i)
    if (polled_[first_watch + i].revents && active()) watches_[i].callback();
  lifecycle_in_->poll(true);
  for (const auto& port : ports_)
    if (port.get() != lifecycle_in_ && port->where() == Where::in_loop) port->poll(active());
  if (!finished_) run_timers();
}

int Node::spin() try {
  const RealTimePriority priority(uses_real_time());
  enter(erp::Lifecycle::inactive);
  gate_.open();
  while (!finished_) {
    wait();
    serve();
  }
  gate_.close();
  if (active())
    for (auto& callback : deactivate_) callback();
  enter(erp::Lifecycle::finalized);
  return exit_code_;
} catch (const std::exception& error) {
  gate_.close();
  report(erp::Severity::fault, identity_.component, "exception", error.what());
  enter(erp::Lifecycle::error);
  return 1;
}

}  // namespace node
