#include <algorithm>
#include <fstream>
#include <iterator>

#include "launch/erp/run/component_row.hpp"
#include "launch/erp/run/run.hpp"
#include "launch/erp/text/duration.hpp"

/// The status of a run.
namespace launch {
namespace {

constexpr std::int64_t max_heartbeat_age_ns = 1'000'000'000;  // ten heartbeats

template <class Enum>
std::string name_in(Enum value) {
  for (const auto& [name, named] : xml::Names<Enum>::list)
    if (named == value) return name;
  return "";
}

}  // namespace

std::string Run::state_of(std::size_t index) const {
  const Phase phase = supervisor_.phase(index);
  const bool on_bus = phase == Phase::active || phase == Phase::inactive;
  if (on_bus && time_.now_ns() - members_[index].heartbeat_ns > max_heartbeat_age_ns)
    return "silent";
  return name_of(phase);
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
  const auto stopped_ns = frame_watch_.is_stopped() && is_bus_disturbed()
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

Row Run::row(std::size_t index) {
  Member& member = members_[index];
  Row row{.name = plan_.processes[index].name, .state = state_of(index)};
  row.restarts = static_cast<long>(supervisor_.restarts(index));
  if (member.process) {
    row.pid = member.process->pid();
    row.cpu_percent = member.share.measure(member.process->pid(), time_.now_ns());
  }
  if (member.heartbeat) fill_measurements(row, *member.heartbeat);
  return row;
}

Status Run::status() {
  Status status{.graph = graph_.name,
                .device = name_in(graph_.device),
                .time = name_in(graph_.time),
                .stage = name_of(supervisor_.stage()),
                .elapsed_s = time_.elapsed_s(),
                .device_s = time_.device_s(),
                .remaining_s = supervisor_.stage() == Stage::running ? time_.remaining_s() : -1};
  for (std::size_t i = 0; i < members_.size(); ++i) status.rows.push_back(row(i));
  return status;
}

}  // namespace launch
