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
/// Processor time: the watchdog resets 10 ms after the last kick, of which up to one period is idle.
constexpr std::int64_t watchdog_ns = 8 * ms;
constexpr int could_not_run = 1, robot_gone = 3;  // exit codes of an ECU's process

std::int64_t read_clock_ns(clockid_t clock) {
  timespec time{};
  if (::clock_gettime(clock, &time) != 0) return 0;
  return 1000 * ms * time.tv_sec + time.tv_nsec;
}
std::int64_t now_ns() { return read_clock_ns(CLOCK_MONOTONIC); }

/// An ECU has a processor of its own; here it runs before other programs, if that is permitted.
void set_real_time_priority(int priority) {
  const sched_param param{priority};
  (void)::sched_setscheduler(0, SCHED_FIFO, &param);
}
constexpr int program_priority = 10, circuit_priority = 20;

/// One ECU: its process, while it has power.
class Ecu {
 public:
  explicit Ecu(const Rack::Slot& slot) : slot_(slot) {}

  bool on() const { return pid_ > 0; }
  bool pending_or_on() const { return on() || due_ns_; }
  pid_t pid() const { return pid_; }

  void start(frame_reset_cause cause) {
    int pipe[2];
    if (::pipe2(pipe, O_NONBLOCK | O_CLOEXEC) != 0) return;
    due_ns_.reset();
    pid_ = ::fork();
    if (pid_ == 0) become_program(cause, pipe[1]);
    ::close(pipe[1]);
    kicks_ = pipe[0];
    kicked_ = false;
    std::printf("ecu %d: process %d\n", slot_.fitted.ecu, pid_);
    std::fflush(stdout);
  }

  /// Restarts the process when due; resets it when it hangs.
  void supervise() {
    if (due_ns_ && now_ns() >= *due_ns_) start(due_cause_);
    if (!on()) return;
    std::array<char, 64> kicks;
    bool kicked = false;
    while (::read(kicks_, kicks.data(), kicks.size()) > 0) kicked = true;
    if (kicked || !kicked_) time_at_kick_ns_ = processor_time_ns(), kicked_ = kicked_ || kicked;
    if (kicked_ && processor_time_ns() - time_at_kick_ns_ >= watchdog_ns) reset_by_watchdog();
  }

  void has_ended(int status) {
    release_pwm();
    ::close(kicks_);
    pid_ = 0;
    if (WIFEXITED(status) && WEXITSTATUS(status) == could_not_run) return;
    const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    const bool without_supply =
        !hung_ && (signal == SIGKILL || signal == SIGTERM ||
                   (WIFEXITED(status) && WEXITSTATUS(status) == robot_gone));
    due_cause_ = without_supply ? FRAME_RESET_BROWN_OUT : FRAME_RESET_WATCHDOG;
    due_ns_ = now_ns() + restart_ns;
    std::printf("ecu %d: %s\n", slot_.fitted.ecu,
                hung_            ? "hung, reset by its watchdog"
                : without_supply ? "lost its supply"
                                 : "crashed, reset by its watchdog");
    hung_ = false;
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
    hung_ = true;
    release_pwm();
    ::kill(pid_, SIGKILL);
    int status = 0;
    ::waitpid(pid_, &status, 0);
    has_ended(status);
  }

  [[noreturn]] void become_program(frame_reset_cause cause, int kick) {
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    set_real_time_priority(program_priority);
    sigset_t none;
    ::sigemptyset(&none);
    ::sigprocmask(SIG_SETMASK, &none, nullptr);
    try {
      run(slot_.fitted, slot_.place, cause, kick);
      ::_exit(robot_gone);
    } catch (const std::exception& error) {
      std::fprintf(stderr, "ecu %d: %s\n", slot_.fitted.ecu, error.what());
    }
    ::_exit(could_not_run);
  }

  std::int64_t processor_time_ns() const {
    clockid_t clock;
    return ::clock_getcpuclockid(pid_, &clock) == 0 ? read_clock_ns(clock) : 0;
  }

  Rack::Slot slot_;
  pid_t pid_ = 0;
  int kicks_ = -1;
  bool kicked_ = false, hung_ = false;
  std::int64_t time_at_kick_ns_ = 0;  ///< processor time at the last kick
  std::optional<std::int64_t> due_ns_;
  frame_reset_cause due_cause_ = FRAME_RESET_POWER;
};

int ending_signals() {
  sigset_t set;
  ::sigemptyset(&set);
  for (const int signal : {SIGINT, SIGTERM}) ::sigaddset(&set, signal);
  ::sigprocmask(SIG_BLOCK, &set, nullptr);
  return ::signalfd(-1, &set, SFD_NONBLOCK | SFD_CLOEXEC);
}

void collect(std::vector<Ecu>& ecus) {
  int status = 0;
  for (pid_t pid = 0; (pid = ::waitpid(-1, &status, WNOHANG)) > 0;)
    for (Ecu& ecu : ecus)
      if (ecu.pid() == pid) ecu.has_ended(status);
}

}  // namespace

int run_rack(const Rack& rack) {
  const int signals = ending_signals();
  set_real_time_priority(circuit_priority);
  std::vector<Ecu> ecus(rack.slots.begin(), rack.slots.end());
  for (Ecu& ecu : ecus) ecu.start(FRAME_RESET_POWER);
  const auto is_needed = [](const Ecu& ecu) { return ecu.pending_or_on(); };
  pollfd ended{signals, POLLIN, 0};
  const timespec often{0, 500'000};
  while (::ppoll(&ended, 1, &often, nullptr) == 0 && std::ranges::any_of(ecus, is_needed)) {
    for (Ecu& ecu : ecus) ecu.supervise();
    collect(ecus);
  }
  const bool ran = std::ranges::any_of(ecus, is_needed);
  for (Ecu& ecu : ecus) ecu.switch_off();
  ::close(signals);
  return ran ? 0 : 1;
}

}  // namespace board
