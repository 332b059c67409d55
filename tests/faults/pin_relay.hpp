#pragma once
#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <pthread.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <catch2/catch.hpp>
#include <functional>
#include <map>
#include <mutex>
#include <thread>
#include <vector>

#include "components/node/clock.hpp"
#include "firmware/board/wire.h"

namespace faults {

/// The relay on the ECUs' pins: all messages between their converters and the simulated robot pass
/// through it, are recorded with the time, and can be changed in transit.
class PinRelay {
 public:
  struct Drive {
    std::int64_t at_ns;  ///< since 1970
    int ecu;
    std::array<std::int16_t, 2> duty;
  };
  using Alter = std::function<void(int ecu, board_readings&)>;

  /// Listens for ECUs on `port`; the robot listens on `robot_port`.
  PinRelay(int port, int robot_port)
      : ecu_socket_(listening_socket(port)), robot_socket_(connected_socket(robot_port)) {
    thread_ = std::thread([this] { relay(); });
    const sched_param priority{15};  // if permitted; the relay replaces wires, which have no delay
    (void)pthread_setschedparam(thread_.native_handle(), SCHED_FIFO, &priority);
  }
  ~PinRelay() {
    done_ = true;
    thread_.join();
    ::close(ecu_socket_), ::close(robot_socket_);
  }

  /// Passes readings through `alter` from now on. Returns the time of the start.
  std::int64_t alter(Alter alter) {
    const std::lock_guard lock(guard_);
    alter_ = std::move(alter);
    return node::wall_ns();
  }
  void pass_unchanged() { alter(nullptr); }

  /// Injects a fault into an ECU's program. Returns the time.
  std::int64_t inject(int ecu, wire_fault_kind kind, int periods = 1) {
    const wire_fault fault{std::uint8_t(kind), std::uint16_t(periods)};
    std::array<std::uint8_t, WIRE_MESSAGE_MAX> bytes;
    const unsigned size = wire_pack_fault(bytes.data(), std::uint8_t(ecu), &fault);
    const std::lock_guard lock(guard_);
    send_to_ecu(ecu, bytes.data(), size);
    return node::wall_ns();
  }

  std::vector<Drive> drives_since(std::int64_t from_ns) {
    const std::lock_guard lock(guard_);
    std::vector<Drive> drives;
    for (const Drive& drive : drives_)
      if (drive.at_ns >= from_ns) drives.push_back(drive);
    return drives;
  }
  void clear() {
    const std::lock_guard lock(guard_);
    drives_.clear();
  }

 private:
  static sockaddr_in loopback(int port) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(std::uint16_t(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    return address;
  }
  static int listening_socket(int port) {
    const int fd = ::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    const auto address = loopback(port);
    REQUIRE(::bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
    return fd;
  }
  static int connected_socket(int port) {
    const int fd = ::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    const auto address = loopback(port);
    REQUIRE(::connect(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
    return fd;
  }

  void relay() {
    while (!done_) {
      std::array<pollfd, 2> ready{{{ecu_socket_, POLLIN, 0}, {robot_socket_, POLLIN, 0}}};
      if (::poll(ready.data(), 2, 20) <= 0) continue;
      if (ready[0].revents) receive_from_ecu();
      if (ready[1].revents) receive_from_robot();
    }
  }
  void receive_from_ecu() {
    std::array<std::uint8_t, 512> bytes;
    sockaddr_in from{};
    socklen_t size = sizeof from;
    const ssize_t n = ::recvfrom(ecu_socket_, bytes.data(), bytes.size(), 0,
                                 reinterpret_cast<sockaddr*>(&from), &size);
    const std::lock_guard lock(guard_);
    wire_reader reader{};
    for (ssize_t i = 0; i < n; ++i) {
      if (wire_take(&reader, bytes[std::size_t(i)]) != WIRE_DRIVE) continue;
      Drive drive{node::wall_ns(), wire_ecu(&reader), {}};
      wire_unpack_drive(&reader, drive.duty.data());
      drives_.push_back(drive);
      ecu_addresses_[drive.ecu] = from;
    }
    (void)::send(robot_socket_, bytes.data(), std::size_t(n), 0);
  }
  void receive_from_robot() {
    std::array<std::uint8_t, 512> bytes;
    const ssize_t n = ::recv(robot_socket_, bytes.data(), bytes.size(), 0);
    const std::lock_guard lock(guard_);
    for (ssize_t i = 0; i < n; ++i)
      if (wire_take(&robot_reader_, bytes[std::size_t(i)]) == WIRE_READINGS) forward_readings();
  }
  void forward_readings() {
    board_readings readings;
    wire_unpack_readings(&robot_reader_, &readings);
    const int ecu = wire_ecu(&robot_reader_);
    if (alter_) alter_(ecu, readings);
    std::array<std::uint8_t, WIRE_MESSAGE_MAX> bytes;
    send_to_ecu(ecu, bytes.data(), wire_pack_readings(bytes.data(), std::uint8_t(ecu), &readings));
  }
  void send_to_ecu(int ecu, const std::uint8_t* bytes, unsigned size) {
    const auto& to = ecu_addresses_[ecu];
    (void)::sendto(ecu_socket_, bytes, size, 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
  }

  int ecu_socket_, robot_socket_;
  std::mutex guard_;
  Alter alter_;
  std::map<int, sockaddr_in> ecu_addresses_;
  wire_reader robot_reader_{};
  std::vector<Drive> drives_;
  std::atomic<bool> done_ = false;
  std::thread thread_;
};

}  // namespace faults
