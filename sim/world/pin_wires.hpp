#pragma once
#include <netinet/in.h>

#include <functional>
#include <map>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "firmware/board/wire.h"

/// How ECUs that run elsewhere are reached: by datagrams on a port of loopback, and over serial
/// lines at 1 Mbaud, where a microcontroller hangs. What is said is firmware/board/wire.h.
namespace sim {

class PinWires {
 public:
  using Peer = std::variant<sockaddr_in, int>;  ///< a datagram's sender, or a line's descriptor

  /// `port` 0: no datagrams; `lines`: devices, separated by blanks. Throws std::runtime_error for a
  /// port that is taken and a line that cannot be opened.
  PinWires(int port, const std::string& lines);
  ~PinWires();
  PinWires(const PinWires&) = delete;
  PinWires& operator=(const PinWires&) = delete;

  /// To wait on.
  std::vector<int> descriptors() const;
  /// Takes what has come, message by message.
  void hear(const std::function<void(const Peer&, wire_kind, const wire_reader&)>& take);
  /// What finds no room is lost, as on a wire.
  void send(const Peer& to, std::span<const std::uint8_t> bytes);
  std::uint64_t unreadable() const;

 private:
  using Take = std::function<void(const Peer&, wire_kind, const wire_reader&)>;
  void hear_datagrams(const Take& take);
  void hear_line(int line, const Take& take);

  int socket_ = -1;
  std::map<std::pair<in_addr_t, in_port_t>, wire_reader> senders_;  ///< what each has begun
  std::map<int, wire_reader> lines_;
};

}  // namespace sim
