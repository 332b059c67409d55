#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "hal/can/backends.hpp"

// Frames on a multicast group of the loopback interface, several to a datagram:
//   "erpc"  then per frame: identifier u16 little endian, size u8, 8 bytes of data.
namespace erp::can {
namespace {

constexpr std::size_t frames_per_datagram = 64, header_bytes = 4, frame_bytes = 11, data_offset = 3;
constexpr std::size_t datagram_bytes = header_bytes + frames_per_datagram * frame_bytes;
constexpr char magic[header_bytes + 1] = "erpc";

[[noreturn]] void fail(const std::string& action) {
  throw std::runtime_error(action + ": " + std::strerror(errno));
}

Descriptor udp_socket() {
  const int fd = ::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (fd < 0) fail("no UDP socket");
  return Descriptor(fd);
}

template <class Value>
void set(const Descriptor& socket, int level, int option, const Value& value, const char* action) {
  if (::setsockopt(socket.get(), level, option, &value, sizeof value) != 0) fail(action);
}

sockaddr_in address(in_addr host, int port) {
  sockaddr_in result{};
  result.sin_family = AF_INET;
  result.sin_addr = host;
  result.sin_port = htons(static_cast<std::uint16_t>(port));
  return result;
}

void bind_to(const Descriptor& socket, const sockaddr_in& where) {
  if (::bind(socket.get(), reinterpret_cast<const sockaddr*>(&where), sizeof where) != 0)
    fail("cannot listen on this group and port");
}

in_addr loopback() { return in_addr{htonl(INADDR_LOOPBACK)}; }

class UdpBus final : public CanBus {
 public:
  UdpBus(in_addr group, int port)
      : receiver_(udp_socket()), sender_(udp_socket()), group_(address(group, port)) {
    set(receiver_, SOL_SOCKET, SO_REUSEADDR, 1, "cannot share the port");
    set(receiver_, SOL_SOCKET, SO_RCVBUF, 1 << 20, "cannot set the receive buffer");
    set(receiver_, SOL_SOCKET, SO_TIMESTAMPNS, 1, "cannot enable receive timestamps");
    bind_to(receiver_, group_);
    set(receiver_, IPPROTO_IP, IP_ADD_MEMBERSHIP, ip_mreq{group, loopback()},
        "cannot join the group on loopback");
    set(sender_, IPPROTO_IP, IP_MULTICAST_IF, loopback(), "cannot send on loopback");
    set(sender_, IPPROTO_IP, IP_MULTICAST_LOOP, 1, "cannot enable multicast loopback");
    set(sender_, IPPROTO_IP, IP_MULTICAST_TTL, 0, "cannot limit multicast to this machine");
    bind_to(sender_, address(loopback(), 0));
    socklen_t size = sizeof own_address_;
    if (::getsockname(sender_.get(), reinterpret_cast<sockaddr*>(&own_address_), &size) != 0)
      fail("cannot read the port of the socket");
  }

  std::size_t send(std::span<const CanFrame> frames) override {
    std::size_t taken = 0;
    while (taken < frames.size()) {
      const auto batch =
          frames.subspan(taken, std::min(frames_per_datagram, frames.size() - taken));
      if (!send_datagram(batch)) break;
      taken += batch.size();
    }
    counters_.sent += taken;
    counters_.refused += frames.size() - taken;
    return taken;
  }

  std::size_t receive(std::span<CanFrame> frames, double timeout_s) override {
    if (waiting_.empty() && !wait_readable(receiver_.get(), timeout_s)) return 0;
    std::size_t filled = take_waiting(frames);
    while (filled < frames.size() && receive_datagram())
      filled += take_waiting(frames.subspan(filled));
    return filled;
  }

  int fd() const override { return receiver_.get(); }
  BusCounters counters() const override { return counters_; }
  void record(FrameSink* sink) override { sink_ = sink; }

 private:
  bool send_datagram(std::span<const CanFrame> frames) {
    std::array<std::uint8_t, datagram_bytes> datagram;
    std::memcpy(datagram.data(), magic, header_bytes);
    std::uint8_t* at = datagram.data() + header_bytes;
    for (const CanFrame& frame : frames) {
      at[0] = static_cast<std::uint8_t>(frame.id & 0xFF);
      at[1] = static_cast<std::uint8_t>(frame.id >> 8);
      at[2] = frame.size;
      std::memcpy(at + data_offset, frame.data, 8);
      at += frame_bytes;
    }
    const auto size = static_cast<std::size_t>(at - datagram.data());
    return ::sendto(sender_.get(), datagram.data(), size, MSG_DONTWAIT | MSG_NOSIGNAL,
                    reinterpret_cast<const sockaddr*>(&group_),
                    sizeof group_) == static_cast<ssize_t>(size);
  }

  /// Receives one datagram; false when none is waiting. Ignores own datagrams.
  bool receive_datagram() {
    std::array<std::uint8_t, datagram_bytes + 1> datagram;
    alignas(cmsghdr) std::array<char, 64> control;
    sockaddr_in from{};
    iovec part{datagram.data(), datagram.size()};
    msghdr message{&from, sizeof from, &part, 1, control.data(), control.size(), 0};
    const ssize_t size = ::recvmsg(receiver_.get(), &message, MSG_DONTWAIT);
    if (size < 0) return false;
    const bool is_own = from.sin_port == own_address_.sin_port &&
                        from.sin_addr.s_addr == own_address_.sin_addr.s_addr;
    if (is_own && !sink_) return true;
    const auto frames = unpack(std::span(datagram).first(static_cast<std::size_t>(size)));
    if (sink_)
      for (const CanFrame& frame : frames) sink_->frame(frame, stamp_ns(message), is_own);
    if (is_own) return true;
    counters_.received += frames.size();
    counters_.unreadable += frames.empty();
    waiting_ = frames;
    return true;
  }

  static std::int64_t stamp_ns(msghdr& message) {
    for (cmsghdr* part = CMSG_FIRSTHDR(&message); part; part = CMSG_NXTHDR(&message, part))
      if (part->cmsg_level == SOL_SOCKET && part->cmsg_type == SO_TIMESTAMPNS) {
        timespec stamp;
        std::memcpy(&stamp, CMSG_DATA(part), sizeof stamp);
        return to_ns(stamp);
      }
    return 0;
  }

  /// The frames of a datagram, in `storage_`; empty: not our format.
  std::span<CanFrame> unpack(std::span<const std::uint8_t> datagram) {
    const bool is_our_format = datagram.size() > header_bytes &&
                               datagram.size() <= datagram_bytes &&
                               (datagram.size() - header_bytes) % frame_bytes == 0 &&
                               std::memcmp(datagram.data(), magic, header_bytes) == 0;
    if (!is_our_format) return {};
    const std::size_t count = (datagram.size() - header_bytes) / frame_bytes;
    const std::uint8_t* at = datagram.data() + header_bytes;
    for (std::size_t i = 0; i < count; ++i, at += frame_bytes) {
      storage_[i].id = static_cast<std::uint16_t>(at[0] | at[1] << 8);
      storage_[i].size = at[2];
      std::memcpy(storage_[i].data, at + data_offset, 8);
    }
    return std::span(storage_).first(count);
  }

  std::size_t take_waiting(std::span<CanFrame> frames) {
    const std::size_t count = std::min(frames.size(), waiting_.size());
    std::copy_n(waiting_.begin(), count, frames.begin());
    waiting_ = waiting_.subspan(count);
    return count;
  }

  Descriptor receiver_, sender_;
  sockaddr_in group_, own_address_{};
  std::array<CanFrame, frames_per_datagram> storage_;  ///< of the last datagram
  std::span<CanFrame> waiting_;  ///< frames of storage_ that were not yet returned
  FrameSink* sink_ = nullptr;
  BusCounters counters_;
};

}  // namespace

std::unique_ptr<CanBus> open_udp(const std::string& group, int port) {
  in_addr host{};
  if (::inet_pton(AF_INET, group.c_str(), &host) != 1 || !IN_MULTICAST(ntohl(host.s_addr)))
    throw std::runtime_error("\"" + group +
                             "\" is not a multicast address; write one from 239.0.0.0 to "
                             "239.255.255.255, e.g. udp:239.255.42.1:20000");
  return std::make_unique<UdpBus>(host, port);
}

}  // namespace erp::can
