#include "launch/erp/run/run.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include "components/node/clock.hpp"
#include "components/node/real_time.hpp"
#include "components/node/security.hpp"
#include "launch/erp/run/run_folder.hpp"
#include "launch/erp/text/duration.hpp"

namespace launch {
namespace {

constexpr int tick_ms = 20;  // chosen: the start-up advances by one component per tick
constexpr std::int64_t plain_output_period_ns = 20'000'000;  // chosen
constexpr std::int64_t redraw_period_ns = 200'000'000;       // chosen
constexpr double min_reported_delay_s = 0.2;  // chosen: a larger delay is reported at the end

std::vector<SupervisedProcess> processes_of(const Plan& plan) {
  std::vector<SupervisedProcess> processes;
  for (const auto& process : plan.processes)
    processes.push_back({process.name, process.restart,
                         process.role == Role::device || process.role == Role::robot_behind_bus});
  return processes;
}

std::string prefix_of(erp::Severity severity) {
  if (severity == erp::Severity::info) return "";
  return severity == erp::Severity::warning ? "warning: " : "fault: ";
}

/// The name of the role in a security folder.
const char* security_role(Role role) {
  switch (role) {
    case Role::logger:
      return "logger";
    case Role::plant:
      return "plant";
    case Role::controller:
      return "controller";
    case Role::robot_behind_bus:
    case Role::device:
      break;
  }
  return "device";
}

/// With DDS Security a component has the identity of its role.
std::vector<std::string> environment_of(Role role) {
  if (node::security_folder().empty()) return {};
  return {"ERP_SECURITY=" + node::security_folder_of(security_role(role))};
}

Tuning tuning_of(const Plan& plan) {
  Tuning tuning;
  tuning.restart.max_restarts = plan.max_restarts;
  tuning.start_timeout_ns = static_cast<std::int64_t>(1e9 * plan.ready_timeout_s);
  return tuning;
}

}  // namespace

Run::Run(const erp::Graph& graph, const std::string& robot, Plan plan, const std::string& folder)
    : graph_(graph),
      plan_(std::move(plan)),
      inputs_(plan_.inputs),
      folder_(folder),
      log_(folder + "/erp.log", std::ios::trunc),
      bus_(robot),
      supervisor_(processes_of(plan_), tuning_of(plan_)),
      time_(graph.duration_s, graph.time == erp::Time::lockstep),
      screen_(stdout),
      members_(plan_.processes.size()) {
  for (std::size_t i = 0; i < members_.size(); ++i) {
    index_of_[plan_.processes[i].name] = i;
    std::filesystem::remove(plan_.processes[i].log_file);
  }
}

int Run::execute() {
  time_.start(node::monotonic_ns());
  if (finds_conflict()) return 2;
  print(graph_.name + ": " + std::to_string(members_.size()) + " processes, logs in " + folder_);
  if (const auto security = node::security_folder(); !security.empty())
    print("DDS Security with the certificates of " + security + ", which expire on " +
          node::security_expires());
  if (graph_.time != erp::Time::lockstep && !node::may_run_in_real_time())
    print(
        "no real-time priority: on a busy machine control loops may miss deadlines and oscillate; "
        "raise ulimit -r to 20");
  supervisor_.start(time_.now_ns());
  execute_actions();
  while (!supervisor_.done()) {
    wait();
    time_.tick(node::monotonic_ns());
    poll_bus();
    handle_signals();
    reap();
    stop_after_duration();
    supervisor_.tick(time_.now_ns());
    execute_actions();
    watch_frames();
    renew_if_stopped();
    run_when_active();
    if (time_.now_ns() - last_drawn_ns_ <
        (screen_.is_terminal() ? redraw_period_ns : plain_output_period_ns))
      continue;
    screen_.show(status());
    last_drawn_ns_ = time_.now_ns();
  }
  poll_bus();
  screen_.show(status());
  print_end();
  return supervisor_.exit_code();
}

void Run::wait() {
  std::vector<pollfd> polled{{bus_.descriptor(), POLLIN, 0}, {signals_.descriptor(), POLLIN, 0}};
  for (const auto& member : members_)
    if (member.process) polled.push_back({member.process->descriptor(), POLLIN, 0});
  poll(polled.data(), polled.size(), tick_ms);
}

void Run::poll_bus() {
  bus_.poll({[this](const auto& message) { on_state(message); },
             [this](const auto& message) { on_event(message); },
             [this](const auto& message) { on_clock(message); }});
}

void Run::on_state(const erp::ComponentState& state) {
  const auto entry = index_of_.find(state.component);
  if (entry == index_of_.end()) return;
  Member& member = members_[entry->second];
  // A component of this run belongs to the process group of the process that was started for it.
  const pid_t group = getpgid(state.pid);
  if (group < 0) return;  // last heartbeat of a process that has ended
  if (!member.process || group != member.process->pid()) return reject_conflict(state);
  member.heartbeat = state;
  member.heartbeat_ns = time_.now_ns();
  if (plan_.processes[entry->second].role == Role::plant)
    frame_watch_.on_heartbeat(state.steps, time_.now_ns());
  supervisor_.on_heartbeat(entry->second,
                           {static_cast<erp::Lifecycle>(state.lifecycle), state.peers, state.links},
                           time_.now_ns());
}

void Run::on_event(const erp::Event& event) {
  std::string text =
      std::string(event.component) + ": " + prefix_of(static_cast<erp::Severity>(event.severity));
  if (event.subject[0] && std::string(event.subject) != event.component)
    text += std::string(event.subject) + ": ";
  if (is_ending()) log(text + event.text);
  else print(text + event.text);
}

/// After the end of the device, the other components report that it is missing; these events are
/// logged but not printed.
bool Run::is_ending() const {
  const auto& device = members_.back().heartbeat;
  return supervisor_.stage() == Stage::stopping ||
         (device && device->lifecycle == static_cast<std::uint8_t>(erp::Lifecycle::finalized));
}

void Run::on_clock(const erp::Clock& clock) {
  time_.on_device_clock(clock.stamp_ns, clock.real_time_factor);
}

void Run::reap() {
  for (std::size_t i = 0; i < members_.size(); ++i) {
    auto& process = members_[i].process;
    if (!process) continue;
    const auto ending = process->poll();
    if (!ending) continue;
    process.reset();
    supervisor_.on_exit(i, *ending, time_.now_ns());
  }
}

void Run::handle_signals() {
  while (const int number = signals_.take()) {
    if (supervisor_.stage() == Stage::stopping) {
      print("interrupted again; killing the remaining processes");
      supervisor_.kill_now();
    } else {
      supervisor_.stop(number == SIGINT ? "interrupted" : "terminated by a signal", 0,
                       time_.now_ns());
    }
  }
}

void Run::stop_after_duration() {
  if (supervisor_.stage() == Stage::running) time_.running();
  if (time_.is_over())
    supervisor_.stop(to_text_s(graph_.duration_s) + " are over", 0, time_.now_ns());
}

void Run::execute_actions() {
  for (const auto& action : supervisor_.take_actions()) {
    auto& process = members_[action.member].process;
    switch (action.kind) {
      case Action::Kind::spawn:
        spawn(action.member);
        break;
      case Action::Kind::activate:
        bus_.command(plan_.processes[action.member].name, erp::Lifecycle::active);
        break;
      case Action::Kind::terminate:
        if (process) process->send(SIGTERM);
        break;
      case Action::Kind::kill:
        if (process) process->send(SIGKILL);
        break;
      case Action::Kind::print:
        print(action.text);
        break;
      case Action::Kind::show_log:
        show_log(action.member);
        break;
    }
  }
}

void Run::spawn(std::size_t index) {
  const auto& planned = plan_.processes[index];
  std::string line;
  for (const auto& argument : planned.argv) line += argument + " ";
  std::ofstream(planned.log_file, std::ios::app) << "$ " << line << '\n';
  members_[index].heartbeat.reset();
  if (const auto file = inputs_.changed(); !file.empty()) {
    print(planned.name + ": not started, because " + file +
          " has changed since the launch; start the graph again");
    return supervisor_.on_exit(index, {bad_input, 0}, time_.now_ns());
  }
  try {
    // If the launcher is killed, SIGTERM lets the logger close its file.
    const int death_signal = planned.role == Role::logger ? SIGTERM : SIGKILL;
    members_[index].process.emplace(planned.argv, planned.log_file, death_signal,
                                    environment_of(planned.role));
  } catch (const std::system_error& error) {
    print(planned.name + ": " + error.what());
    supervisor_.on_exit(index, {1, 0}, time_.now_ns());
  }
}

void Run::show_log(std::size_t index) {
  const auto& file = plan_.processes[index].log_file;
  print("  last lines of " + file + ":");
  for (const auto& line : last_lines(file, max_log_lines)) print("  | " + line);
}

void Run::log(const std::string& text) {
  log_ << fmt::format("{:8.2f}  {}", time_.elapsed_s(), text) << std::endl;
}

void Run::print(const std::string& text) {
  log(text);
  screen_.print(time_.elapsed_s(), text);
}

void Run::print_end() {
  std::string text = graph_.name + ": ended after " + to_text_s(time_.elapsed_s());
  if (time_.device_delay_s() > min_reported_delay_s)
    print("the device time is " + to_text_s(time_.device_delay_s()) +
          " behind real time because the machine is too busy; use --lockstep");
  if (time_.device_s() >= 0) text += ", " + to_text_s(time_.device_s()) + " of device time";
  for (std::size_t i = 0; i < members_.size(); ++i)
    if (const auto count = supervisor_.restarts(i))
      text += ", " + plan_.processes[i].name + " restarted " + std::to_string(count) +
              (count == 1 ? " time" : " times");
  print(text + ", exit code " + std::to_string(supervisor_.exit_code()));
}

}  // namespace launch
