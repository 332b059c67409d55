#pragma once
#include <netinet/in.h>

#include <functional>
#include <map>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "firmware/board/wire.h"

/// Connection to ECUs that run as separate programs: datagrams on a loopback port, and serial lines
/// at 1 Mbaud for a microcontroller. The messages are defined in firmware/board/wire.h.
namespace sim {

class PinWires {
 public:
  using Peer = std::variant<sockaddr_in, int>;  ///< sender of a datagram, or descriptor of a line

  /// `port` 0: no datagrams; `lines`: devices, separated by blanks. Throws std::runtime_error if
  /// the port is in use or a line cannot be opened.
  PinWires(int port, const std::string& lines);
  ~PinWires();
  PinWires(const PinWires&) = delete;
  PinWires& operator=(const PinWires&) = delete;

  /// File descriptors to wait on.
  std::vector<int> descriptors() const;
  /// Receives all pending messages and calls `on_message` for each.
  void receive(const std::function<void(const Peer&, wire_kind, const wire_reader&)>& on_message);
  /// A message without room in the buffer is lost, as on a wire.
  void send(const Peer& to, std::span<const std::uint8_t> bytes);
  /// Number of messages that could not be decoded.
  std::uint64_t unreadable() const;

 private:
  using OnMessage = std::function<void(const Peer&, wire_kind, const wire_reader&)>;
  void receive_datagrams(const OnMessage& on_message);
  void receive_line(int line, const OnMessage& on_message);

  int socket_ = -1;
  std::map<std::pair<in_addr_t, in_port_t>, wire_reader> senders_;  ///< partial message of each
  std::map<int, wire_reader> lines_;
};

}  // namespace sim
