#include "launch/erp/run/supervisor.hpp"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <utility>

namespace launch {
namespace {

std::string seconds(std::int64_t duration_ns) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f s", 1e-9 * static_cast<double>(duration_ns));
  return text;
}

}  // namespace

Supervisor::Supervisor(std::vector<SupervisedProcess> processes, Tuning tuning) : tuning_(tuning) {
  for (auto& process : processes) members_.push_back({std::move(process), BackOff(tuning.restart)});
}

void Supervisor::start(std::int64_t now_ns) {
  started_ns_ = now_ns;
  for (auto& member : members_) member.spawn_due_ns = now_ns;
  spawn_due(now_ns);
}

void Supervisor::tick(std::int64_t now_ns) {
  if (stage_ == Stage::stopping) return stop_next(now_ns);
  if (stage_ == Stage::done) return;
  spawn_due(now_ns);
  for (Member& member : members_)
    if (member.renewed) kill_if_overdue(member, tuning_.renew_timeout_ns, now_ns);
  if (stage_ == Stage::starting) await_all(now_ns);
  if (stage_ == Stage::activating || stage_ == Stage::running) activate_next(now_ns);
}

void Supervisor::on_heartbeat(std::size_t index, const Heartbeat& heartbeat, std::int64_t now_ns) {
  Member& member = members_[index];
  if (heartbeat.links != member.heartbeat.links) member.links_changed_ns = now_ns;
  member.heartbeat = heartbeat;
  member.finalized = heartbeat.lifecycle == erp::Lifecycle::finalized;
  const bool is_starting = member.phase == Phase::starting;
  if (is_starting && heartbeat.lifecycle == erp::Lifecycle::inactive) {
    member.phase = Phase::inactive;
    member.links_changed_ns = now_ns;
  }
  if ((is_starting || member.phase == Phase::inactive) &&
      heartbeat.lifecycle == erp::Lifecycle::active)
    member.phase = Phase::active;
}

void Supervisor::on_exit(std::size_t index, const Ending& ending, std::int64_t now_ns) {
  Member& member = members_[index];
  const std::string what = member.process.name + ": " + to_string(ending);
  if (stage_ == Stage::stopping) {
    const bool is_stopped = ending.clean() || (ending.signal == SIGTERM && !member.killed);
    member.phase = is_stopped ? Phase::ended : Phase::failed;
    if (is_stopped) return;
    exit_code_ = std::max(exit_code_, 1);
    print(what + " while stopping");
    if (!member.killed) add_action(Action::Kind::show_log, index);
    return;
  }
  member.phase = Phase::ended;
  if (std::exchange(member.renewed, false)) {
    member.phase = Phase::waiting;
    member.killed = false;
    member.spawn_due_ns = now_ns;
    ++member.restarts;
    return;
  }
  if (ending.clean() && member.process.ends_run)
    return stop(member.process.name + " has reached the end of the run", 0, now_ns);
  if (!ending.signal && ending.code == bad_input)
    return fail(index, what + ", input rejected", bad_input, now_ns);
  if (member.process.restart == erp::Restart::always ||
      (!ending.clean() && member.process.restart == erp::Restart::on_failure))
    return restart(index, ending, now_ns);
  if (ending.clean()) return print(member.process.name + " has ended");
  fail(index, what + ", restart=\"never\"", 1, now_ns);
}

void Supervisor::restart(std::size_t index, const Ending& ending, std::int64_t now_ns) {
  Member& member = members_[index];
  const std::string what = member.process.name + ": " + to_string(ending);
  const auto delay_ns = member.back_off.on_failure(now_ns);
  const std::size_t k = member.back_off.restarts_in_window();
  if (!delay_ns)
    return fail(index,
                what + ", given up after " + std::to_string(k) + " restarts in " +
                    seconds(tuning_.restart.window_ns),
                1, now_ns);
  ++member.restarts;
  member.phase = Phase::backing_off;
  member.spawn_due_ns = now_ns + *delay_ns;
  print(what + ", restart " + std::to_string(k) + " of " +
        std::to_string(tuning_.restart.max_restarts) + " in " + seconds(*delay_ns));
  if (k == 1 && !ending.clean()) add_action(Action::Kind::show_log, index);
}

void Supervisor::fail(std::size_t index, const std::string& reason, int exit_code,
                      std::int64_t now_ns) {
  members_[index].phase = Phase::failed;
  add_action(Action::Kind::show_log, index);
  stop(reason, exit_code, now_ns);
}

void Supervisor::stop(const std::string& reason, int exit_code, std::int64_t now_ns) {
  exit_code_ = std::max(exit_code_, exit_code);
  if (stage_ == Stage::stopping || stage_ == Stage::done) return;
  print(reason + "; stopping");
  stage_ = Stage::stopping;
  for (auto& member : members_) {
    member.requested_ns.reset();
    if (member.phase == Phase::waiting || member.phase == Phase::backing_off)
      member.phase = Phase::ended;
  }
  stop_next(now_ns);
}

void Supervisor::renew(std::int64_t now_ns) {
  if (stage_ == Stage::stopping || stage_ == Stage::done) return;
  stage_ = Stage::starting;
  started_ns_ = now_ns;
  for (auto& member : members_) {
    if (!is_alive(member) || member.renewed) continue;
    member.renewed = true;
    member.phase = Phase::stopping;
    member.requested_ns = now_ns;
    add_action(Action::Kind::terminate, index_of(member));
  }
}

void Supervisor::kill_now() {
  stage_ = Stage::stopping;
  exit_code_ = std::max(exit_code_, 1);
  for (auto& member : members_) {
    if (!is_alive(member)) continue;
    member.phase = Phase::stopping;
    member.killed = true;
    add_action(Action::Kind::kill, index_of(member));
  }
}

bool Supervisor::is_alive(const Member& member) const {
  return member.phase == Phase::starting || member.phase == Phase::inactive ||
         member.phase == Phase::active || member.phase == Phase::stopping;
}

bool Supervisor::is_ready(const Member& member, std::int64_t now_ns) const {
  // each component discovers the n − 1 other processes and the launcher
  const auto n = std::count_if(members_.begin(), members_.end(),
                               [this](const Member& other) { return is_alive(other); });
  return member.phase == Phase::inactive && member.heartbeat.peers >= n &&
         now_ns - member.links_changed_ns >= tuning_.settle_ns;
}

void Supervisor::spawn_due(std::int64_t now_ns) {
  for (auto& member : members_) {
    if (member.phase != Phase::waiting && member.phase != Phase::backing_off) continue;
    if (now_ns < member.spawn_due_ns) continue;
    member.phase = Phase::starting;
    member.heartbeat = {};
    member.finalized = false;
    member.requested_ns.reset();
    add_action(Action::Kind::spawn, index_of(member));
  }
}

void Supervisor::await_all(std::int64_t now_ns) {
  std::string missing;
  for (const auto& member : members_)
    if (member.phase != Phase::active && member.phase != Phase::ended && !is_ready(member, now_ns))
      missing += (missing.empty() ? "" : ", ") + member.process.name;
  if (missing.empty()) {
    stage_ = Stage::activating;
    return print("all components are ready");
  }
  if (now_ns - started_ns_ >= tuning_.start_timeout_ns)
    stop("not ready after " + seconds(tuning_.start_timeout_ns) + ": " + missing, 1, now_ns);
}

void Supervisor::activate_next(std::int64_t now_ns) {
  bool all_active = true;
  for (auto& member : members_) {
    if (member.phase == Phase::active || member.phase == Phase::ended) continue;
    all_active = false;
    const bool recently_requested =
        member.requested_ns && now_ns - *member.requested_ns < tuning_.resend_ns;
    if (is_ready(member, now_ns) && !recently_requested) {
      member.requested_ns = now_ns;
      add_action(Action::Kind::activate, index_of(member));
    }
    if (stage_ == Stage::activating) return;  // in order: one at a time
  }
  if (all_active && stage_ == Stage::activating) {
    stage_ = Stage::running;
    print("all components are active");
  }
}

void Supervisor::stop_next(std::int64_t now_ns) {
  bool is_waiting = false;  // a member has received its stop request and is not finalized
  bool all_ended = true;
  for (auto member = members_.rbegin(); member != members_.rend(); ++member) {
    if (!is_alive(*member)) continue;
    all_ended = false;
    if (!member->requested_ns && !is_waiting) {
      member->phase = Phase::stopping;
      member->requested_ns = now_ns;
      add_action(Action::Kind::terminate, index_of(*member));
    }
    is_waiting |= !member->finalized;
    kill_if_overdue(*member, tuning_.stop_timeout_ns, now_ns);
  }
  if (all_ended) stage_ = Stage::done;
}

void Supervisor::kill_if_overdue(Member& member, std::int64_t timeout_ns, std::int64_t now_ns) {
  if (member.killed || !member.requested_ns) return;
  if (now_ns - *member.requested_ns < timeout_ns) return;
  member.killed = true;
  print(member.process.name + " did not stop within " + seconds(timeout_ns) + "; killing it");
  add_action(Action::Kind::kill, index_of(member));
}

void Supervisor::add_action(Action::Kind kind, std::size_t index, std::string text) {
  actions_.push_back({kind, index, std::move(text)});
}

std::vector<Action> Supervisor::take_actions() { return std::exchange(actions_, {}); }

const char* name_of(Phase phase) {
  switch (phase) {
    case Phase::waiting:
      return "waiting";
    case Phase::starting:
      return "starting";
    case Phase::inactive:
      return "inactive";
    case Phase::active:
      return "active";
    case Phase::backing_off:
      return "restarting";
    case Phase::stopping:
      return "stopping";
    case Phase::ended:
      return "ended";
    case Phase::failed:
      break;
  }
  return "failed";
}

const char* name_of(Stage stage) {
  switch (stage) {
    case Stage::starting:
      return "starting";
    case Stage::activating:
      return "activating";
    case Stage::running:
      return "running";
    case Stage::stopping:
      return "stopping";
    case Stage::done:
      break;
  }
  return "done";
}

}  // namespace launch
