#include "hal/ecu/program.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <sys/timerfd.h>
#include <unistd.h>

#include <array>
#include <ctime>
#include <stdexcept>

#include "firmware/board/wire.h"

namespace board {
namespace {

constexpr long period_ns = 2'000'000;

int period_timer() {
  const int timer = ::timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK | TFD_CLOEXEC);
  const itimerspec each{{0, period_ns}, {0, period_ns}};
  if (timer < 0 || ::timerfd_settime(timer, 0, &each, nullptr) != 0)
    throw std::runtime_error("no timer for the control period");
  return timer;
}

int converter_socket(const sockaddr_in& robot) {
  const int fd = ::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (fd < 0 || ::connect(fd, reinterpret_cast<const sockaddr*>(&robot), sizeof robot) != 0)
    throw std::runtime_error("no socket for the converters");
  return fd;
}

/// Processor time of this program. It excludes the time of other programs, because an ECU runs
/// none.
std::int64_t processor_time_ns() {
  timespec time{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return std::int64_t{1'000'000'000} * time.tv_sec + time.tv_nsec;
}

class Program {
 public:
  Program(const board_fitted& fitted, const Place& place, frame_reset_cause cause, int kick)
      : fitted_(fitted),
        kick_(kick),
        bus_(erp::open_bus(place.bus, place.bus_options)),
        converters_(converter_socket(place.converters)),
        timer_(period_timer()) {
    wait_for_robot();
    erp::CanFrame boot;
    ecu_board_init(&board_, &fitted, cause, &boot);
    bus_->send({&boot, 1});
  }

  /// Returns false when the robot no longer answers.
  bool wait_and_serve() {
    std::array<pollfd, 3> ready{
        {{bus_->fd(), POLLIN, 0}, {converters_, POLLIN, 0}, {timer_, POLLIN, 0}}};
    ::poll(ready.data(), ready.size(), -1);
    if (ready[0].revents) receive();
    if (ready[1].revents) read_converters();
    std::uint64_t periods = 0;
    if (::read(timer_, &periods, sizeof periods) > 0) on_timer();
    return silent_periods_ < (period_.readings.turn ? lockstep_periods : robot_silent_periods);
  }

 private:
  static constexpr int robot_poll_ms = 8;          ///< chosen: four periods
  static constexpr int robot_silent_periods = 50;  ///< without a reading: 100 ms; chosen
  static constexpr int lockstep_periods = 5'000;   ///< in lockstep: 10 s; chosen

  /// Requests readings until the robot answers; the ECU boots then.
  void wait_for_robot() {
    pollfd answer{converters_, POLLIN, 0};
    do {
      send_duties({});
      readings_requested_ = false;
      request_readings();
    } while (::poll(&answer, 1, robot_poll_ms) <= 0);
  }

  /// Requests the readings of the next period; in lockstep after the host has answered this one.
  void request_readings() {
    if (readings_requested_ || ecu_board_awaits_host(&board_, &period_.readings)) return;
    std::array<std::uint8_t, WIRE_MESSAGE_MAX> bytes;
    const unsigned size = wire_pack_sample(bytes.data(), fitted_.ecu, period_.readings.turn);
    (void)::send(converters_, bytes.data(), size, 0);
    readings_requested_ = true;
  }

  /// Repeats frames and requests that may have been lost.
  void on_timer() {
    kick();
    if (ecu_board_awaits_host(&board_, &period_.readings)) {
      silent_periods_ = 0;
      if (++host_wait_periods_ % ECU_BOARD_REPEAT_PERIODS == 0) repeat();
      return;
    }
    host_wait_periods_ = 0;
    if (++silent_periods_ % ECU_BOARD_REQUEST_PERIODS == 0) readings_requested_ = false;
    request_readings();
  }
  void repeat() {
    std::array<erp::CanFrame, ECU_LINK_FRAMES_MAX> frames;
    bus_->send(std::span(frames).first(ecu_board_repeat(&board_, frames.data())));
  }

  void receive() {
    std::array<erp::CanFrame, 64> frames;
    while (const auto count = bus_->receive(frames, 0))
      for (std::size_t i = 0; i < count && bus_off_periods_ == 0; ++i)
        ecu_board_receive(&board_, &frames[i]);
    request_readings();
  }

  void read_converters() {
    std::array<std::uint8_t, 1500> datagram;
    for (ssize_t n = 0; (n = ::recv(converters_, datagram.data(), datagram.size(), 0)) > 0;)
      for (ssize_t i = 0; i < n; ++i) handle(wire_take(&reader_, datagram[std::size_t(i)]));
  }

  void handle(wire_kind kind) {
    if (kind == WIRE_READINGS) {
      wire_unpack_readings(&reader_, &period_.readings);
      wire_count_from_reset(&counters_, &period_.readings);
      run_period();
    }
    if (kind != WIRE_FAULT) return;
    wire_fault fault;
    wire_unpack_fault(&reader_, &fault);
    if (fault.kind == WIRE_FAULT_HANG)
      for (volatile bool forever = true; forever;) continue;
    if (fault.kind == WIRE_FAULT_BUSY) busy_periods_ = fault.periods;
    if (fault.kind == WIRE_FAULT_BUS_OFF) bus_off_periods_ = fault.periods;
  }

  /// The simulated robot sends readings every 2 ms of simulated time; this is the ECU's clock.
  void run_period() {
    silent_periods_ = 0;
    readings_requested_ = false;
    if (ecu_board_awaits_robot(&board_, &period_.readings)) return;  // repeated readings
    const std::int64_t start_ns = processor_time_ns();
    std::array<erp::CanFrame, ECU_LINK_FRAMES_MAX> frames;
    std::array<std::int16_t, 2> duty;
    period_.bus_off = bus_off_periods_ > 0;
    const unsigned count = ecu_board_period(&board_, &period_, duty.data(), frames.data());
    send_duties(duty);
    if (bus_off_periods_ == 0) bus_->send(std::span(frames).first(count));
    while (busy_periods_ > 0 && processor_time_ns() - start_ns < period_ns) continue;
    if (busy_periods_ > 0) --busy_periods_;
    if (bus_off_periods_ > 0) --bus_off_periods_;
    period_.overran = processor_time_ns() - start_ns >= period_ns;
    request_readings();
  }

  /// Sends both PWM duties to the robot and kicks the watchdog.
  void send_duties(const std::array<std::int16_t, 2>& duty) {
    std::array<std::uint8_t, WIRE_MESSAGE_MAX> bytes;
    const unsigned size = wire_pack_drive(bytes.data(), fitted_.ecu, duty.data());
    (void)::send(converters_, bytes.data(), size,
                 0);  // may fail before the robot runs; the next period sends again
    kick();
  }
  void kick() { (void)!::write(kick_, "", 1); }

  board_fitted fitted_;
  int kick_;
  ecu_board board_{};
  board_period period_{};
  std::unique_ptr<erp::CanBus> bus_;
  int converters_, timer_;
  wire_reader reader_{};
  wire_counters counters_{};
  bool readings_requested_ = false;  ///< the next readings were requested
  int silent_periods_ = 0;           ///< since the last readings
  unsigned host_wait_periods_ = 0;   ///< lockstep: periods of waiting for the host
  unsigned busy_periods_ = 0, bus_off_periods_ = 0;
};

}  // namespace

void run(const board_fitted& fitted, const Place& place, frame_reset_cause cause, int kick) {
  Program program(fitted, place, cause, kick);
  while (program.wait_and_serve()) continue;
}

}  // namespace board
