#include "components/node/node.hpp"

#include <poll.h>
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

/// SIGINT and SIGTERM become readable on a descriptor. Must run before DDS starts its threads.
int open_signals() {
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

Node::Node(Options options, std::string robot_name)
    : options_(std::move(options)),
      identity_{std::move(robot_name), options_.name, options_.priority},
      clock_(options_.time),
      signals_(open_signals()) {
  prctl(PR_SET_TIMERSLACK, 1000);  // wake within a microsecond of a deadline, not fifty
  participant_ = join(options_.name);
  participants_reader_ = Entity(
      dds_create_reader(participant_.id(), DDS_BUILTIN_TOPIC_DCPSPARTICIPANT, nullptr, nullptr),
      "read participants");
  state_out_ = &advertise<erp::ComponentState>();
  event_out_ = &advertise<erp::Event>();
  lifecycle_in_ = &subscribe<erp::LifecycleCommand>(
      [this](const erp::LifecycleCommand& command) { obey(command); }, 4, Where::in_loop);
  state_.pid = getpid();
}

Node::~Node() {
  gate_.close();
  close(signals_);
}

void Node::every(std::int64_t period_ns, std::function<void()> act) {
  timers_.push_back({period_ns, monotonic_ns() + period_ns, std::move(act)});
}

void Node::watch(int descriptor, std::function<void()> act) {
  watches_.push_back({descriptor, false, std::move(act)});
}

void Node::set_lifecycle(erp::Lifecycle lifecycle) {
  if (lifecycle == lifecycle_) return;
  lifecycle_ = lifecycle;
  active_ = lifecycle == erp::Lifecycle::active;
  heartbeat();
}

void Node::obey(const erp::LifecycleCommand& command) {
  if (identity_.component != command.component) return;
  const auto target = static_cast<erp::Lifecycle>(command.target);
  if (target == erp::Lifecycle::finalized) return finish();
  if (target == erp::Lifecycle::active && !active()) {
    const auto now_ns = monotonic_ns();
    for (auto& timer : timers_) timer.due_ns = now_ns + timer.period_ns;
    for (const auto& port : ports_) port->poll(false);  // what came while inactive is old
    set_lifecycle(erp::Lifecycle::active);
    for (auto& act : activate_) act();
  }
  if (target == erp::Lifecycle::inactive && active()) {
    for (auto& act : deactivate_) act();
    set_lifecycle(erp::Lifecycle::inactive);
  }
}

void Node::count_step(std::int64_t stamp_ns) {
  const auto now_ns = monotonic_ns();
  ++state_.steps;
  age_.add_ns(clock_.now_ns() - stamp_ns);
  const auto interval_ns = now_ns - last_step_ns_;
  if (last_step_ns_ && last_interval_ns_) jitter_.add_ns(std::abs(interval_ns - last_interval_ns_));
  last_interval_ns_ = last_step_ns_ ? interval_ns : 0;
  last_step_ns_ = now_ns;
}

void Node::report(erp::Severity severity, const std::string& subject, const std::string& code,
                  const std::string& text) {
  spdlog::log(level_of(severity), "{}{}{}: {}", subject, subject.empty() ? "" : " ", code, text);
  erp::Event event;
  event.stamp_ns = clock_.now_ns();
  event.severity = static_cast<std::uint8_t>(severity);
  erp::assign_shortened(event.subject, subject);
  erp::assign_shortened(event.code, code);
  erp::assign_shortened(event.text, text);
  event_out_->publish(event);
  erp::assign_shortened(state_.note, text);
}

void Node::finish(int exit_code) {
  gate_.close();
  exit_code_ = std::max(exit_code_, exit_code);
  finished_ = true;
  wake_.raise();
}

std::uint32_t Node::count_peers() {
  void* samples[256] = {};
  dds_sample_info_t info[256];
  const auto n =
      dds_read_mask(participants_reader_.id(), samples, info, 256, 256, DDS_ALIVE_INSTANCE_STATE);
  if (n <= 0) return 0;
  dds_return_loan(participants_reader_.id(), samples, n);
  return static_cast<std::uint32_t>(n - 1);
}

void Node::heartbeat() {
  const auto now_ns = monotonic_ns();
  state_.lifecycle = static_cast<std::uint8_t>(lifecycle_);
  state_.stamp_ns = clock_.now_ns();
  state_.links = 0, state_.missed = 0;
  for (const auto& port : ports_) state_.links += port->matched(), state_.missed += port->missed();
  state_.peers = count_peers();
  if (heartbeat_last_ns_ && now_ns - heartbeat_last_ns_ > heartbeat_ns / 2) {
    state_.rate_Hz = 1e9 * static_cast<double>(state_.steps - steps_at_heartbeat_) /
                     static_cast<double>(now_ns - heartbeat_last_ns_);
    heartbeat_last_ns_ = now_ns, steps_at_heartbeat_ = state_.steps;
  }
  if (!heartbeat_last_ns_) heartbeat_last_ns_ = now_ns;
  std::copy(age_.counts().begin(), age_.counts().end(), state_.age_bins);
  std::copy(jitter_.counts().begin(), jitter_.counts().end(), state_.jitter_bins);
  state_out_->publish(state_);
  heartbeat_due_ns_ = now_ns + heartbeat_ns;
}

void Node::run_timers() {
  const auto now_ns = monotonic_ns();
  if (now_ns >= heartbeat_due_ns_) heartbeat();
  if (!active()) return;
  for (auto& timer : timers_) {
    if (now_ns < timer.due_ns) continue;
    const auto late = (now_ns - timer.due_ns) / timer.period_ns;
    state_.overruns += static_cast<std::uint64_t>(late);
    timer.due_ns += (late + 1) * timer.period_ns;
    timer.act();
  }
}

void Node::wait() {
  std::int64_t due_ns = heartbeat_due_ns_;
  if (active())
    for (const auto& timer : timers_) due_ns = std::min(due_ns, timer.due_ns);
  const auto left_ns = std::max<std::int64_t>(0, due_ns - monotonic_ns());
  const timespec timeout{left_ns / 1'000'000'000, left_ns % 1'000'000'000};
  std::array<pollfd, 8> polled{};
  nfds_t n = 0;
  polled[n++] = {wake_.descriptor(), POLLIN, 0};
  polled[n++] = {signals_, POLLIN, 0};
  if (active())
    for (const auto& watch : watches_)
      if (n < polled.size()) polled[n++] = {watch.descriptor, POLLIN, 0};
  ppoll(polled.data(), n, &timeout, nullptr);
  if (polled[0].revents) wake_.clear();
  if (polled[1].revents) finish();
  for (nfds_t i = 2; i < n; ++i) watches_[i - 2].ready = polled[i].revents != 0;
}

void Node::serve() {
  const auto lock = gate_.lock();
  gate_.rethrow();
  if (finished_) return;
  for (auto& watch : watches_)
    if (std::exchange(watch.ready, false) && active()) watch.act();
  lifecycle_in_->poll(true);
  for (const auto& port : ports_)
    if (port.get() != lifecycle_in_ && port->where() == Where::in_loop) port->poll(active());
  if (!finished_) run_timers();
}

int Node::spin() try {
  set_lifecycle(erp::Lifecycle::inactive);
  gate_.open();
  if (!options_.managed) {
    const auto lock = gate_.lock();
    erp::LifecycleCommand start;
    erp::assign(start.component, identity_.component);
    start.target = static_cast<std::uint8_t>(erp::Lifecycle::active);
    obey(start);
  }
  while (!finished_) {
    wait();
    serve();
  }
  gate_.close();
  if (active())
    for (auto& act : deactivate_) act();
  set_lifecycle(erp::Lifecycle::finalized);
  return exit_code_;
} catch (const std::exception& error) {
  gate_.close();
  report(erp::Severity::fault, identity_.component, "exception", error.what());
  set_lifecycle(erp::Lifecycle::error);
  return 1;
}

}  // namespace node
