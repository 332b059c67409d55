#include "sim/world/pin_wires.hpp"

#include <fcntl.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <sstream>
#include <stdexcept>

namespace sim {
namespace {

int listen_on(int port) {
  const int fd = ::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (fd < 0 || ::bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) {
    const std::string reason = std::strerror(errno);
    if (fd >= 0) ::close(fd);
    throw std::runtime_error("cannot listen for ECUs on port " + std::to_string(port) + ": " +
                             reason + "; give another converter_port");
  }
  return fd;
}

int open_line(const std::string& device) {
  const int fd = ::open(device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  termios raw{};
  if (fd < 0 || ::tcgetattr(fd, &raw) != 0) {
    const std::string reason = std::strerror(errno);
    if (fd >= 0) ::close(fd);
    throw std::runtime_error("converter_lines: cannot open " + device + ": " + reason +
                             "; give a serial device, for example /dev/ttyUSB0");
  }
  ::cfmakeraw(&raw);
  ::cfsetspeed(&raw, B1000000);
  ::tcsetattr(fd, TCSANOW, &raw);
  return fd;
}

}  // namespace

PinWires::PinWires(int port, const std::string& lines) {
  std::istringstream list(lines);
  for (std::string device; list >> device;) lines_[open_line(device)] = {};
  if (port > 0) socket_ = listen_on(port);
}

PinWires::~PinWires() {
  if (socket_ >= 0) ::close(socket_);
  for (const auto& [line, reader] : lines_) ::close(line);
}

std::vector<int> PinWires::descriptors() const {
  std::vector<int> all;
  if (socket_ >= 0) all.push_back(socket_);
  for (const auto& [line, reader] : lines_) all.push_back(line);
  return all;
}

void PinWires::receive(const OnMessage& on_message) {
  if (socket_ >= 0) receive_datagrams(on_message);
  for (const auto& [line, reader] : lines_) receive_line(line, on_message);
}

void PinWires::receive_datagrams(const OnMessage& on_message) {
  std::array<std::uint8_t, 2048> datagram;
  sockaddr_in from{};
  socklen_t size = sizeof from;
  for (ssize_t n = 0; (n = ::recvfrom(socket_, datagram.data(), datagram.size(), 0,
                                      reinterpret_cast<sockaddr*>(&from), &size)) >= 0;) {
    wire_reader& reader = senders_[{from.sin_addr.s_addr, from.sin_port}];
    for (const std::uint8_t byte : std::span(datagram).first(static_cast<std::size_t>(n)))
      if (const wire_kind kind = wire_take(&reader, byte)) on_message(from, kind, reader);
  }
}

void PinWires::receive_line(int line, const OnMessage& on_message) {
  std::array<std::uint8_t, 2048> bytes;
  wire_reader& reader = lines_.at(line);
  for (ssize_t n = 0; (n = ::read(line, bytes.data(), bytes.size())) > 0;)
    for (const std::uint8_t byte : std::span(bytes).first(static_cast<std::size_t>(n)))
      if (const wire_kind kind = wire_take(&reader, byte)) on_message(line, kind, reader);
}

void PinWires::send(const Peer& to, std::span<const std::uint8_t> bytes) {
  if (const int* line = std::get_if<int>(&to)) {
    (void)!::write(*line, bytes.data(), bytes.size());
    return;
  }
  const auto& address = std::get<sockaddr_in>(to);
  (void)::sendto(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL,
                 reinterpret_cast<const sockaddr*>(&address), sizeof address);
}

std::uint64_t PinWires::unreadable() const {
  std::uint64_t sum = 0;
  for (const auto& [sender, reader] : senders_) sum += reader.unreadable;
  for (const auto& [line, reader] : lines_) sum += reader.unreadable;
  return sum;
}

}  // namespace sim
