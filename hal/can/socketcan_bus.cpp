#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "hal/can/backends.hpp"

namespace erp::can {
namespace {

constexpr std::size_t batch = 64;  // frames to one system call

Descriptor raw_socket() {
  const int fd = ::socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW);
  if (fd >= 0) return Descriptor(fd);
  if (errno == EAFNOSUPPORT || errno == EPROTONOSUPPORT)
    throw std::invalid_argument("this kernel has no SocketCAN; use udp:239.255.42.1:20000");
  throw std::runtime_error(std::string("no CAN socket: ") + std::strerror(errno));
}

unsigned index_of(const std::string& interface) {
  const unsigned index = ::if_nametoindex(interface.c_str());
  if (index == 0)
    throw std::invalid_argument("no interface \"" + interface +
                                "\"; `ip -br link show type can` lists them, `ip link add " +
                                "vcan0 type vcan` makes a virtual one");
  return index;
}

template <class Value>
void set(const Descriptor& socket, int option, const Value& value) {
  if (::setsockopt(socket.get(), SOL_CAN_RAW, option, &value, sizeof value) != 0)
    throw std::runtime_error(std::string("cannot set up the CAN socket: ") + std::strerror(errno));
}

/// Of a socket bound to an interface that is down: ENETDOWN, while bind itself succeeds.
int pending_error(const Descriptor& socket) {
  int error = 0;
  socklen_t size = sizeof error;
  ::getsockopt(socket.get(), SOL_SOCKET, SO_ERROR, &error, &size);
  return error;
}

/// Messages of one sendmmsg or recvmmsg, pointing at their frames.
struct Batch {
  std::array<can_frame, batch> frames{};
  std::array<iovec, batch> parts{};
  std::array<mmsghdr, batch> messages{};
  Batch() {
    for (std::size_t i = 0; i < batch; ++i) {
      parts[i] = {&frames[i], sizeof frames[i]};
      messages[i].msg_hdr.msg_iov = &parts[i];
      messages[i].msg_hdr.msg_iovlen = 1;
    }
  }
  Batch(const Batch&) = delete;
  Batch& operator=(const Batch&) = delete;
};

class SocketCanBus final : public CanBus {
 public:
  explicit SocketCanBus(const std::string& interface) : socket_(raw_socket()) {
    sockaddr_can where{};
    where.can_family = AF_CAN;
    where.can_ifindex = static_cast<int>(index_of(interface));
    // Data frames with 11-bit identifiers only, and the controller's error frames.
    set(socket_, CAN_RAW_FILTER, can_filter{0, CAN_EFF_FLAG | CAN_RTR_FLAG});
    set(socket_, CAN_RAW_ERR_FILTER,
        can_err_mask_t{CAN_ERR_BUSOFF | CAN_ERR_RESTARTED | CAN_ERR_CRTL | CAN_ERR_ACK |
                       CAN_ERR_BUSERROR});
    if (::bind(socket_.get(), reinterpret_cast<const sockaddr*>(&where), sizeof where) != 0)
      throw std::invalid_argument("\"" + interface + "\" is no CAN interface (" +
                                  std::strerror(errno) +
                                  "); `ip -br link show type can` lists them");
    if (pending_error(socket_) == ENETDOWN)
      throw std::runtime_error("interface \"" + interface + "\" is down; `ip link set " +
                               interface + " up type can bitrate 1000000`");
  }

  /// In bus-off the kernel takes frames and forgets them: `counters().off` is the only sign.
  std::size_t send(std::span<const CanFrame> frames) override {
    std::size_t taken = 0;
    while (taken < frames.size()) {
      const std::size_t some = send_batch(frames.subspan(taken));
      if (some == 0) break;
      taken += some;
    }
    counters_.sent += taken;
    counters_.refused += frames.size() - taken;
    return taken;
  }

  std::size_t receive(std::span<CanFrame> frames, double timeout_s) override {
    if (!wait_readable(socket_.get(), timeout_s)) return 0;
    std::size_t filled = 0;
    while (filled < frames.size() && receive_batch(frames, filled)) continue;
    return filled;
  }

  int fd() const override { return socket_.get(); }
  BusCounters counters() const override { return counters_; }

 private:
  std::size_t send_batch(std::span<const CanFrame> frames) {
    const std::size_t count = std::min(batch, frames.size());
    for (std::size_t i = 0; i < count; ++i) {
      can_frame& out = outgoing_.frames[i];
      out.can_id = frames[i].id;
      out.len = std::min<std::uint8_t>(frames[i].size, CAN_MAX_DLEN);
      std::memcpy(out.data, frames[i].data, sizeof out.data);
    }
    const int sent = ::sendmmsg(socket_.get(), outgoing_.messages.data(),
                                static_cast<unsigned>(count), MSG_DONTWAIT);
    if (sent < 0 && errno == ENETDOWN) counters_.off = true;
    return sent > 0 ? static_cast<std::size_t>(sent) : 0;  // ENOBUFS, EAGAIN: the queue is full
  }

  bool receive_batch(std::span<CanFrame> frames, std::size_t& filled) {
    const auto room = static_cast<unsigned>(std::min(batch, frames.size() - filled));
    const int count =
        ::recvmmsg(socket_.get(), incoming_.messages.data(), room, MSG_DONTWAIT, nullptr);
    if (count < 0 && errno == ENETDOWN) counters_.off = true;
    for (int i = 0; i < count; ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (is_data(incoming_.frames[k], incoming_.messages[k].msg_len))
        frames[filled++] = read(incoming_.frames[k]);
    }
    return count > 0;
  }

  bool is_data(const can_frame& in, unsigned size) {
    if (in.can_id & CAN_ERR_FLAG) {
      ++counters_.errors;
      if (in.can_id & CAN_ERR_BUSOFF) counters_.off = true;
      if (in.can_id & CAN_ERR_RESTARTED) counters_.off = false;
      return false;
    }
    const bool ours = size == CAN_MTU && in.len <= CAN_MAX_DLEN;
    ++(ours ? counters_.received : counters_.unreadable);
    counters_.off = false;
    return ours;
  }

  static CanFrame read(const can_frame& in) {
    CanFrame frame{static_cast<std::uint16_t>(in.can_id & CAN_SFF_MASK), in.len, {}};
    std::memcpy(frame.data, in.data, sizeof frame.data);
    return frame;
  }

  Descriptor socket_;
  Batch outgoing_, incoming_;
  BusCounters counters_;
};

}  // namespace

std::unique_ptr<CanBus> open_socketcan(const std::string& interface) {
  return std::make_unique<SocketCanBus>(interface);
}

}  // namespace erp::can
