#include "hal/ecu/power.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/signalfd.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <ctime>
#include <exception>
#include <optional>

#include "firmware/board/wire.h"

namespace board {
namespace {

constexpr std::int64_t ms = 1'000'000, restart_ns = 20 * ms;
/// Processor time since the last kick: 10 ms of the watchdog minus one period, which may be idle.
constexpr std::int64_t watchdog_ns = 8 * ms;
constexpr int start_failed = 1, robot_silent = 3;  // exit codes of an ECU's process

std::int64_t read_clock_ns(clockid_t clock) {
  timespec time{};
  if (::clock_gettime(clock, &time) != 0) return 0;
  return 1000 * ms * time.tv_sec + time.tv_nsec;
}
std::int64_t now_ns() { return read_clock_ns(CLOCK_MONOTONIC); }

/// An ECU has its own processor. Here it preempts other programs if that is permitted.
void set_real_time_priority(int priority) {
  const sched_param param{priority};
  (void)::sched_setscheduler(0, SCHED_FIFO, &param);
}
constexpr int program_priority = 10, supply_priority = 20;

/// One ECU: its process, while it has power.
class Ecu {
 public:
  explicit Ecu(const Rack::Slot& slot) : slot_(slot) {}

  bool on() const { return pid_ > 0; }
  bool is_needed() const { return on() || restart_due_ns_; }
  pid_t pid() const { return pid_; }

  void start(frame_reset_cause cause) {
    int pipe[2];
    if (::pipe2(pipe, O_NONBLOCK | O_CLOEXEC) != 0) return;
    restart_due_ns_.reset();
    pid_ = ::fork();
    if (pid_ == 0) become_program(cause, pipe[1]);
    ::close(pipe[1]);
    kick_pipe_ = pipe[0];
    has_kicked_ = false;
    std::printf("ecu %d: process %d\n", slot_.fitted.ecu, pid_);
    std::fflush(stdout);
  }

  /// Restarts the process when due; resets it when it hangs.
  void supervise() {
    if (restart_due_ns_ && now_ns() >= *restart_due_ns_) start(restart_cause_);
    if (!on()) return;
    std::array<char, 64> kicks;
    bool kicked = false;
    while (::read(kick_pipe_, kicks.data(), kicks.size()) > 0) kicked = true;
    if (kicked || !has_kicked_)
      time_at_kick_ns_ = processor_time_ns(), has_kicked_ = has_kicked_ || kicked;
    if (has_kicked_ && processor_time_ns() - time_at_kick_ns_ >= watchdog_ns) reset_by_watchdog();
  }

  void on_end(int status) {
    release_pwm();
    ::close(kick_pipe_);
    pid_ = 0;
    if (WIFEXITED(status) && WEXITSTATUS(status) == start_failed) return;
    const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    const bool lost_supply =
        !is_hung_ && (signal == SIGKILL || signal == SIGTERM ||
                      (WIFEXITED(status) && WEXITSTATUS(status) == robot_silent));
    restart_cause_ = lost_supply ? FRAME_RESET_BROWN_OUT : FRAME_RESET_WATCHDOG;
    restart_due_ns_ = now_ns() + restart_ns;
    std::printf("ecu %d: %s\n", slot_.fitted.ecu,
                is_hung_      ? "hung, reset by its watchdog"
                : lost_supply ? "lost its supply"
                              : "crashed, reset by its watchdog");
    is_hung_ = false;
  }

  void switch_off() {
    if (on()) ::kill(pid_, SIGKILL), ::waitpid(pid_, nullptr, 0);
  }

 private:
  /// Hardware sets PWM to 0, independent of the program.
  void release_pwm() const {
    const std::array<std::int16_t, 2> off{};
    std::array<std::uint8_t, WIRE_MESSAGE_MAX> bytes;
    const unsigned size = wire_pack_drive(bytes.data(), slot_.fitted.ecu, off.data());
    const int fd = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    (void)::sendto(fd, bytes.data(), size, 0,
                   reinterpret_cast<const sockaddr*>(&slot_.place.converters),
                   sizeof slot_.place.converters);
    ::close(fd);
  }

  void reset_by_watchdog() {
    is_hung_ = true;
    release_pwm();
    ::kill(pid_, SIGKILL);
    int status = 0;
    ::waitpid(pid_, &status, 0);
    on_end(status);
  }

  [[noreturn]] void become_program(frame_reset_cause cause, int kick) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    set_real_time_priority(program_priority);
    sigset_t none;
    ::sigemptyset(&none);
    ::sigprocmask(SIG_SETMASK, &none, nullptr);
    try {
      run(slot_.fitted, slot_.place, cause, kick);
      ::_exit(robot_silent);
    } catch (const std::exception& error) {
      std::fprintf(stderr, "ecu %d: %s\n", slot_.fitted.ecu, error.what());
    }
    ::_exit(start_failed);
  }

  std::int64_t processor_time_ns() const {
    clockid_t clock;
    return ::clock_getcpuclockid(pid_, &clock) == 0 ? read_clock_ns(clock) : 0;
  }

  Rack::Slot slot_;
  pid_t pid_ = 0;
  int kick_pipe_ = -1;
  bool has_kicked_ = false, is_hung_ = false;
  std::int64_t time_at_kick_ns_ = 0;  ///< processor time at the last kick
  std::optional<std::int64_t> restart_due_ns_;
  frame_reset_cause restart_cause_ = FRAME_RESET_POWER;
};

int ending_signals() {
  sigset_t set;
  ::sigemptyset(&set);
  for (const int signal : {SIGINT, SIGTERM}) ::sigaddset(&set, signal);
  ::sigprocmask(SIG_BLOCK, &set, nullptr);
  return ::signalfd(-1, &set, SFD_NONBLOCK | SFD_CLOEXEC);
}

void collect_ended(std::vector<Ecu>& ecus) {
  int status = 0;
  for (pid_t pid = 0; (pid = ::waitpid(-1, &status, WNOHANG)) > 0;)
    for (Ecu& ecu : ecus)
      if (ecu.pid() == pid) ecu.on_end(status);
}

}  // namespace

int run_rack(const Rack& rack) {
  const int signals = ending_signals();
  set_real_time_priority(supply_priority);
  std::vector<Ecu> ecus(rack.slots.begin(), rack.slots.end());
  for (Ecu& ecu : ecus) ecu.start(FRAME_RESET_POWER);
  const auto is_needed = [](const Ecu& ecu) { return ecu.is_needed(); };
  pollfd ended{signals, POLLIN, 0};
  const timespec poll_period{0, 500'000};
  while (::ppoll(&ended, 1, &poll_period, nullptr) == 0 && std::ranges::any_of(ecus, is_needed)) {
    for (Ecu& ecu : ecus) ecu.supervise();
    collect_ended(ecus);
  }
  const bool any_ran = std::ranges::any_of(ecus, is_needed);
  for (Ecu& ecu : ecus) ecu.switch_off();
  ::close(signals);
  return any_ran ? 0 : 1;
}

}  // namespace board
