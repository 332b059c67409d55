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
#include "launch/erp/text/duration.hpp"
#include "launch/erp/run/run_folder.hpp"

namespace launch {
namespace {

constexpr int tick_ms = 20;                      // chosen: start-up advances by ticks
constexpr std::int64_t change_ns = 20'000'000;   // chosen
constexpr std::int64_t redraw_ns = 200'000'000;  // chosen
constexpr std::size_t shown_log_lines = 12;
constexpr double behind_s = 0.2;  // chosen: worth a word at the end

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

std::string rival_text(const std::string& component, const std::string& robot, long pid) {
  return "\"" + component + "\" of robot " + robot + " runs already on this bus, pid " +
         std::to_string(pid) + "; end its graph, or set ERP_DOMAIN to a number of your own";
}

Tuning tuning_of(const Plan& plan) {
  Tuning tuning;
  tuning.restart.most = plan.most_restarts;
  tuning.start_patience_ns = static_cast<std::int64_t>(1e9 * plan.patience_s);
  return tuning;
}

}  // namespace

Run::Run(const erp::Graph& graph, const std::string& robot, Plan plan, const std::string& folder)
    : graph_(graph),
      plan_(std::move(plan)),
      folder_(folder),
      log_(folder + "/erp.log", std::ios::trunc),
      bus_(robot),
      supervisor_(charges_of(plan_), tuning_of(plan_)),
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
  if (finds_rival()) return 2;
  say(graph_.name + ": " + std::to_string(members_.size()) + " processes, logs in " + folder_);
  if (const auto security = node::security_folder(); !security.empty())
    say("only who holds a certificate of " + security + " takes part, until " +
        node::security_expires());
  if (graph_.time != erp::Time::lockstep && !node::may_run_in_real_time())
    say("no real-time priority (ulimit -r): on a busy machine loops come late, and limbs may swing");
  supervisor_.start(time_.now_ns());
  carry_out();
  while (!supervisor_.done()) {
    wait();
    time_.tick(node::monotonic_ns());
    hear_bus();
    obey_signals();
    reap();
    end_when_due();
    supervisor_.tick(time_.now_ns());
    carry_out();
    if (time_.now_ns() - drawn_ns_ < (screen_.is_terminal() ? redraw_ns : change_ns)) continue;
    screen_.show(status());
    drawn_ns_ = time_.now_ns();
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
  member.heard_ns = time_.now_ns();
  supervisor_.heard(found->second,
                    {static_cast<erp::Lifecycle>(state.lifecycle), state.peers, state.links},
                    time_.now_ns());
}

/// Two graphs cannot drive one robot: the one that comes second starts nothing.
bool Run::finds_rival() {
  for (const auto until_ns = time_.now_ns() + node::discovery_ns(); time_.now_ns() < until_ns;
       time_.tick(node::monotonic_ns())) {
    wait();
    for (const auto& peer : bus_.peers()) {
      if (!index_of_.contains(peer.component)) continue;
      say(rival_text(peer.component, peer.robot, peer.pid));
      return true;
    }
  }
  return false;
}

/// Of one that came while we started: the one that comes second gives way.
void Run::refuse_stranger(const erp::ComponentState& state) {
  if (supervisor_.stage() != Stage::starting && supervisor_.stage() != Stage::activating) return;
  supervisor_.stop(rival_text(state.component, state.robot, state.pid), 2, time_.now_ns());
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
  time_.hear_device(clock.stamp_ns, clock.real_time_factor);
}

void Run::reap() {
  for (std::size_t i = 0; i < members_.size(); ++i) {
    auto& process = members_[i].process;
    if (!process) continue;
    const auto ending = process->poll();
    if (!ending) continue;
    process.reset();
    supervisor_.ended(i, *ending, time_.now_ns());
  }
}

void Run::obey_signals() {
  while (const int number = signals_.take()) {
    if (supervisor_.stage() == Stage::stopping) {
      say("interrupted again; killing what still runs");
      supervisor_.kill_now();
    } else {
      supervisor_.stop(number == SIGINT ? "interrupted" : "told to stop", 0, time_.now_ns());
    }
  }
}

void Run::end_when_due() {
  if (supervisor_.stage() == Stage::running) time_.running();
  if (time_.over()) supervisor_.stop(to_text_s(graph_.duration_s) + " are over", 0, time_.now_ns());
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
    // A killed launcher must not cost the recording its end.
    const int death_signal = planned.role == Role::logger ? SIGTERM : SIGKILL;
    members_[index].process.emplace(planned.argv, planned.log_file, death_signal);
  } catch (const std::system_error& error) {
    say(planned.name + ": " + error.what());
    supervisor_.ended(index, {1, 0}, time_.now_ns());
  }
}

void Run::show_log(std::size_t index) {
  const auto& file = plan_.processes[index].log_file;
  say("  the end of " + file + ":");
  for (const auto& line : last_lines(file, shown_log_lines)) say("  | " + line);
}

void Run::note(const std::string& text) {
  log_ << fmt::format("{:8.2f}  {}", time_.elapsed_s(), text) << std::endl;
}

void Run::say(const std::string& text) {
  note(text);
  screen_.say(time_.elapsed_s(), text);
}

void Run::say_end() {
  std::string text = graph_.name + ": ended after " + to_text_s(time_.elapsed_s());
  if (time_.behind_s() > behind_s)
    say("the device's time fell " + to_text_s(time_.behind_s()) +
        " behind the clock: this machine was too busy for real time; --lockstep waits instead");
  if (time_.device_s() >= 0) text += ", " + to_text_s(time_.device_s()) + " of the device's time";
  for (std::size_t i = 0; i < members_.size(); ++i)
    if (const auto count = supervisor_.restarts(i))
      text += ", " + plan_.processes[i].name + " restarted " + std::to_string(count) +
              (count == 1 ? " time" : " times");
  say(text + ", exit code " + std::to_string(supervisor_.exit_code()));
}

}  // namespace launch
