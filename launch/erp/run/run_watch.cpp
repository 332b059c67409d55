// What a run does besides supervising its processes: watches for other graphs and for frames, starts
// the graph again, homes the robot.
#include <algorithm>
#include <fstream>
#include <iterator>

#include "components/node/clock.hpp"
#include "launch/erp/run/run.hpp"
#include "launch/erp/text/duration.hpp"

namespace launch {
namespace {

std::string conflict_text(const std::string& component, const std::string& robot, long pid) {
  return "\"" + component + "\" of robot " + robot + " already runs on this bus, pid " +
         std::to_string(pid) + "; stop its graph, or set ERP_DOMAIN to another number";
}

}  // namespace

/// Returns true if another graph already controls the robot; then this run starts no process.
bool Run::finds_conflict() {
  for (const auto until_ns = time_.now_ns() + node::discovery_ns(); time_.now_ns() < until_ns;
       time_.tick(node::monotonic_ns())) {
    wait();
    for (const auto& peer : bus_.peers()) {
      const bool is_sole = peer.role == node::plant_role || peer.role == node::device_role;
      if (!index_of_.contains(peer.component) && !is_sole) continue;
      print(conflict_text(peer.component, peer.robot, peer.pid));
      return true;
    }
  }
  return false;
}

/// A component of another graph appeared during the start: this graph stops.
void Run::reject_conflict(const erp::ComponentState& state) {
  if (supervisor_.stage() != Stage::starting && supervisor_.stage() != Stage::activating) return;
  supervisor_.stop(conflict_text(state.component, state.robot, state.pid), 2, time_.now_ns());
}

void Run::watch_frames() {
  bool running = supervisor_.stage() == Stage::running && graph_.time != erp::Time::lockstep;
  std::string silent;
  for (std::size_t i = 0; i < members_.size(); ++i) {
    running = running && supervisor_.phase(i) == Phase::active;
    if (time_.now_ns() - members_[i].heartbeat_ns > FrameWatch::limit_ns / 2)
      silent += (silent.empty() ? "" : ", ") + plan_.processes[i].name;
  }
  has_silent_member_ = !silent.empty();
  const auto change = frame_watch_.update(running, time_.now_ns());
  if (change == FrameWatch::Change::stopped) device_steps_ = device_steps();
  const std::string seconds = to_text_s(frame_watch_.stopped_s(time_.now_ns()));
  if (change == FrameWatch::Change::stopped)
    print("no frame has reached the plant for " + seconds + ", although every process runs" +
          (silent.empty() ? "; check the device"
                          : "; no heartbeat from " + silent +
                                ": the bus is disturbed, or they are "
                                "stopped"));
  if (change == FrameWatch::Change::resumed) print("frames reach the plant again after " + seconds);
}

/// True if a debugger or SIGSTOP has suspended a process.
bool Run::is_any_suspended() const {
  return std::ranges::any_of(members_, [](const Member& member) {
    if (!member.process) return false;
    std::ifstream file("/proc/" + std::to_string(member.process->pid()) + "/stat");
    std::string stat(std::istreambuf_iterator<char>(file), {});
    const auto state = stat.rfind(") ");
    return state != stat.npos && (stat[state + 2] == 'T' || stat[state + 2] == 't');
  });
}

std::uint64_t Run::device_steps() const {
  const auto& heartbeat = members_.back().heartbeat;
  return heartbeat ? heartbeat->steps : 0;
}

/// Without frames: false if the robot itself may be off, which new processes would not change.
bool Run::is_bus_disturbed() const {
  const bool is_simulated = plan_.processes.back().type == "sim";
  return has_silent_member_ || (is_simulated && device_steps() > device_steps_);
}

/// In lockstep a stopped graph waits, and nothing is lost.
void Run::renew_if_stopped() {
  if (graph_.time == erp::Time::lockstep || plan_.max_restarts == 0) return;
  const bool is_running = supervisor_.stage() == Stage::running;
  const auto stopped_ns =
      frame_watch_.is_stopped() && is_bus_disturbed()
          ? static_cast<std::int64_t>(1e9 * frame_watch_.stopped_s(time_.now_ns()))
          : 0;
  switch (renewal_.update(is_running, stopped_ns, time_.now_ns())) {
    case Renewal::Decision::none:
      return;
    case Renewal::Decision::renew:
      if (is_any_suspended()) return;
      print("starting all processes again, because frames do not return");
      return supervisor_.renew(time_.now_ns());
    case Renewal::Decision::give_up:
      return supervisor_.stop("frames did not return within " +
                                  to_text_s(1e-9 * static_cast<double>(Renewal::give_up_ns)),
                              1, time_.now_ns());
  }
}

void Run::run_when_active() {
  const bool is_running = supervisor_.stage() == Stage::running;
  const bool has_become_active = is_running && !std::exchange(was_running_, is_running);
  was_running_ = is_running;
  if (!is_running) when_active_.reset();
  if (plan_.when_active.empty()) return;
  const std::string log = folder_ + "/" + plan_.when_active[1] + ".log";
  if (has_become_active) when_active_.emplace(plan_.when_active, log);
  if (!when_active_) return;
  const auto ending = when_active_->poll();
  if (!ending) return;
  when_active_.reset();
  for (const auto& line : last_lines(log, max_log_lines)) print(plan_.when_active[1] + ": " + line);
  if (!ending->clean())
    print("warning: erp " + plan_.when_active[1] + " failed, " + to_string(*ending));
}

}  // namespace launch
