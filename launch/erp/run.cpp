#include "launch/erp/run.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include "components/node/clock.hpp"
#include "launch/erp/component_row.hpp"
#include "launch/erp/duration.hpp"
#include "launch/erp/run_folder.hpp"

namespace launch {
namespace {

constexpr int tick_ms = 20;                         // chosen: start-up advances by ticks
constexpr std::int64_t change_ns = 20'000'000;      // chosen
constexpr std::int64_t redraw_ns = 200'000'000;     // chosen
constexpr std::int64_t silence_ns = 1'000'000'000;  // ten heartbeats
constexpr std::size_t shown_log_lines = 12;

std::vector<Charge> charges_of(const Plan& plan) {
  std::vector<Charge> charges;
  for (const auto& process : plan.processes)
    charges.push_back({process.name, process.restart,
                       process.role == Role::device || process.role == Role::robot_behind_bus});
  return charges;
}

std::string word_of(erp::Severity severity) {
  if (severity == erp::Severity::info) return "";
  return severity == erp::Severity::warning ? "warning: " : "fault: ";
}

template <class Enum>
std::string word_of(Enum value, const auto& names) {
  for (const auto& [word, named] : names)
    if (named == value) return word;
  return "";
}

}  // namespace

Run::Run(const erp::Graph& graph, const std::string& robot, Plan plan, const std::string& folder)
    : graph_(graph),
      plan_(std::move(plan)),
      folder_(folder),
      log_(folder + "/erp.log", std::ios::trunc),
      bus_(robot),
      supervisor_(charges_of(plan_)),
      screen_(stdout),
      members_(plan_.processes.size()) {
  for (std::size_t i = 0; i < members_.size(); ++i) {
    index_of_[plan_.processes[i].name] = i;
    std::filesystem::remove(plan_.processes[i].log_file);
  }
}

int Run::execute() {
  started_ns_ = now_ns_ = node::monotonic_ns();
  say(graph_.name + ": " + std::to_string(members_.size()) + " processes, logs in " + folder_);
  supervisor_.start(now_ns_);
  carry_out();
  while (!supervisor_.done()) {
    wait();
    now_ns_ = node::monotonic_ns();
    hear_bus();
    obey_signals();
    reap();
    end_when_due();
    supervisor_.tick(now_ns_);
    carry_out();
    if (now_ns_ - drawn_ns_ < (screen_.is_terminal() ? redraw_ns : change_ns)) continue;
    screen_.show(status());
    drawn_ns_ = now_ns_;
  }
  hear_bus();
  screen_.show(status());
  say_end();
  return supervisor_.exit_code();
}

void Run::wait() {
  std::vector<pollfd> polled{{bus_.descriptor(), POLLIN, 0}, {signals_.descriptor(), POLLIN, 0}};
  for (const auto& member : members_)
    if (member.process) polled.push_back({member.process->descriptor(), POLLIN, 0});
  poll(polled.data(), polled.size(), tick_ms);
}

void Run::hear_bus() {
  bus_.poll({[this](const auto& message) { hear(message); },
             [this](const auto& message) { hear(message); },
             [this](const auto& message) { hear(message); }});
}

void Run::hear(const erp::ComponentState& state) {
  const auto found = index_of_.find(state.component);
  if (found == index_of_.end()) return;
  Member& member = members_[found->second];
  // A component of ours is in the group of the process that was started for it.
  const pid_t group = getpgid(state.pid);
  if (group < 0) return;  // a last word of one that is gone
  if (!member.process || group != member.process->pid()) return refuse_stranger(state);
  member.heard = state;
  member.heard_ns = now_ns_;
  supervisor_.heard(found->second,
                    {static_cast<erp::Lifecycle>(state.lifecycle), state.peers, state.links},
                    now_ns_);
}

/// Two graphs cannot drive one robot: the one that comes second gives way.
void Run::refuse_stranger(const erp::ComponentState& state) {
  if (supervisor_.stage() != Stage::starting && supervisor_.stage() != Stage::activating) return;
  supervisor_.stop("another \"" + std::string(state.component) + "\" of robot " + state.robot +
                       " is on this bus, pid " + std::to_string(state.pid) +
                       "; end it (erp ps), or set ERP_DOMAIN to a number of your own",
                   2, now_ns_);
}

void Run::hear(const erp::Event& event) {
  std::string text =
      std::string(event.component) + ": " + word_of(static_cast<erp::Severity>(event.severity));
  if (event.subject[0] && std::string(event.subject) != event.component)
    text += std::string(event.subject) + ": ";
  if (is_ending()) note(text + event.text);
  else say(text + event.text);
}

/// From the device's last word on, the others miss it: worth keeping, but no news.
bool Run::is_ending() const {
  const auto& device = members_.back().heard;
  return supervisor_.stage() == Stage::stopping ||
         (device && device->lifecycle == static_cast<std::uint8_t>(erp::Lifecycle::finalized));
}

void Run::hear(const erp::Clock& clock) {
  if (!first_clock_ns_) first_clock_ns_ = clock.stamp_ns;
  simulated_s_ = 1e-9 * static_cast<double>(clock.stamp_ns - *first_clock_ns_);
  real_time_factor_ = clock.real_time_factor;
}

void Run::reap() {
  for (std::size_t i = 0; i < members_.size(); ++i) {
    auto& process = members_[i].process;
    if (!process) continue;
    const auto ending = process->poll();
    if (!ending) continue;
    process.reset();
    supervisor_.ended(i, *ending, now_ns_);
  }
}

void Run::obey_signals() {
  while (const int number = signals_.take()) {
    if (supervisor_.stage() == Stage::stopping) {
      say("interrupted again; killing what still runs");
      supervisor_.kill_now();
    } else {
      supervisor_.stop(number == SIGINT ? "interrupted" : "told to stop", 0, now_ns_);
    }
  }
}

/// In real time the run lasts so long, whatever is restarted meanwhile.
void Run::end_when_due() {
  if (graph_.duration_s <= 0 || graph_.time == erp::Time::lockstep) return;
  if (supervisor_.stage() != Stage::running) return;
  if (!running_since_ns_) running_since_ns_ = now_ns_;
  if (1e-9 * static_cast<double>(now_ns_ - *running_since_ns_) >= graph_.duration_s)
    supervisor_.stop(to_text_s(graph_.duration_s) + " are over", 0, now_ns_);
}

void Run::carry_out() {
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
      case Action::Kind::say:
        say(action.text);
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
  for (const auto& word : planned.argv) line += word + " ";
  std::ofstream(planned.log_file, std::ios::app) << "$ " << line << '\n';
  members_[index].heard.reset();
  try {
    members_[index].process.emplace(planned.argv, planned.log_file);
  } catch (const std::system_error& error) {
    say(planned.name + ": " + error.what());
    supervisor_.ended(index, {1, 0}, now_ns_);
  }
}

void Run::show_log(std::size_t index) {
  const auto& file = plan_.processes[index].log_file;
  say("  the end of " + file + ":");
  for (const auto& line : last_lines(file, shown_log_lines)) say("  | " + line);
}

void Run::note(const std::string& text) {
  log_ << fmt::format("{:8.2f}  {}", elapsed_s(), text) << std::endl;
}

void Run::say(const std::string& text) {
  note(text);
  screen_.say(elapsed_s(), text);
}

void Run::say_end() {
  std::string text =
      graph_.name + ": ended after " + to_text_s(1e-9 * static_cast<double>(now_ns_ - started_ns_));
  if (simulated_s_ >= 0) text += ", " + to_text_s(simulated_s_) + " simulated";
  say(text + ", exit code " + std::to_string(supervisor_.exit_code()));
  std::error_code ignored;
  if (std::filesystem::exists(plan_.recording, ignored)) say("recording " + plan_.recording);
}

std::string Run::state_of(std::size_t index) const {
  const Phase phase = supervisor_.phase(index);
  const bool on_bus = phase == Phase::active || phase == Phase::inactive;
  if (on_bus && now_ns_ - members_[index].heard_ns > silence_ns) return "silent";
  return name_of(phase);
}

Row Run::row(std::size_t index) {
  Member& member = members_[index];
  Row row{.name = plan_.processes[index].name, .state = state_of(index)};
  row.restarts = static_cast<long>(supervisor_.restarts(index));
  if (member.process) {
    row.pid = member.process->pid();
    row.cpu_percent = member.share.measure(member.process->pid(), now_ns_);
  }
  if (member.heard) fill_figures(row, *member.heard);
  return row;
}

double Run::left_s() const {
  if (graph_.duration_s <= 0 || supervisor_.stage() != Stage::running) return -1;
  if (graph_.time == erp::Time::lockstep)
    return real_time_factor_ > 0
               ? std::max(0.0, graph_.duration_s - simulated_s_) / real_time_factor_
               : -1;
  const auto since_ns = now_ns_ - running_since_ns_.value_or(now_ns_);
  return std::max(0.0, graph_.duration_s - 1e-9 * static_cast<double>(since_ns));
}

Status Run::status() {
  Status status{.graph = graph_.name,
                .device = word_of(graph_.device, xml::Names<erp::Device>::list),
                .time = word_of(graph_.time, xml::Names<erp::Time>::list),
                .stage = name_of(supervisor_.stage()),
                .elapsed_s = elapsed_s(),
                .simulated_s = simulated_s_,
                .left_s = left_s()};
  for (std::size_t i = 0; i < members_.size(); ++i) status.rows.push_back(row(i));
  return status;
}

}  // namespace launch
