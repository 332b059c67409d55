#include "hal/can/socketcan_socket.hpp"

#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <linux/errqueue.h>
#include <linux/net_tstamp.h>
#include <net/if.h>
#include <sys/ioctl.h>

#include <algorithm>
#include <cstring>

namespace erp::can {
namespace {

constexpr std::size_t kernel_bytes_per_frame = 1024;  // a socket buffer of one frame, rounded up

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
void set(const Descriptor& socket, int level, int option, const Value& value) {
  if (::setsockopt(socket.get(), level, option, &value, sizeof value) != 0)
    throw std::runtime_error(std::string("cannot set up the CAN socket: ") + std::strerror(errno));
}

/// A socket bound to an interface that is down reports ENETDOWN; bind itself succeeds.
int pending_error(const Descriptor& socket) {
  int error = 0;
  socklen_t size = sizeof error;
  ::getsockopt(socket.get(), SOL_SOCKET, SO_ERROR, &error, &size);
  return error;
}

void require_fd(const Descriptor& socket, const std::string& interface) {
  ifreq request{};
  std::copy_n(interface.c_str(), std::min(interface.size(), sizeof request.ifr_name - 1),
              request.ifr_name);
  const bool mtu_is_known = ::ioctl(socket.get(), SIOCGIFMTU, &request) == 0;
  if (!mtu_is_known || request.ifr_mtu < static_cast<int>(CANFD_MTU))
    throw std::runtime_error("interface \"" + interface +
                             "\" does not carry CAN FD; `ip link set " + interface +
                             " up type can bitrate 1000000 dbitrate 5000000 fd on`, or remove "
                             "data_bitrate_per_s from robot.xml's can_bus");
}

/// Own frames are also received. The buffer has room for both, beyond the usual limit if permitted.
void enlarge_receive_buffer(const Descriptor& socket) {
  constexpr int bytes = 4 << 20;  // chosen
  if (::setsockopt(socket.get(), SOL_SOCKET, SO_RCVBUFFORCE, &bytes, sizeof bytes) != 0)
    set(socket, SOL_SOCKET, SO_RCVBUF, bytes);
}

void select_received_frames(const Descriptor& socket, const BusOptions& options) {
  set(socket, SOL_CAN_RAW, CAN_RAW_FILTER, can_filter{0, CAN_EFF_FLAG | CAN_RTR_FLAG});
  set(socket, SOL_CAN_RAW, CAN_RAW_ERR_FILTER,
      can_err_mask_t{CAN_ERR_BUSOFF | CAN_ERR_RESTARTED | CAN_ERR_CRTL | CAN_ERR_ACK |
                     CAN_ERR_BUSERROR});
  set(socket, SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS, 1);
  if (options.fd) set(socket, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, 1);
  set(socket, SOL_SOCKET, SO_TIMESTAMPING,
      SOF_TIMESTAMPING_RX_SOFTWARE | SOF_TIMESTAMPING_SOFTWARE | SOF_TIMESTAMPING_RX_HARDWARE |
          SOF_TIMESTAMPING_RAW_HARDWARE);
  set(socket, SOL_SOCKET, SO_RXQ_OVFL, 1);
}

}  // namespace

Descriptor open_raw(const std::string& interface, const BusOptions& options) {
  Descriptor socket = raw_socket();
  sockaddr_can where{};
  where.can_family = AF_CAN;
  where.can_ifindex = static_cast<int>(index_of(interface));
  select_received_frames(socket, options);
  enlarge_receive_buffer(socket);
  // A driver that confirms at once still fills the kernel's queue; this limits our share of it.
  if (options.window > 0)
    set(socket, SOL_SOCKET, SO_SNDBUF,
        static_cast<int>(options.window * kernel_bytes_per_frame / 2));
  if (::bind(socket.get(), reinterpret_cast<const sockaddr*>(&where), sizeof where) != 0)
    throw std::invalid_argument("\"" + interface + "\" is not a CAN interface (" +
                                std::strerror(errno) + "); `ip -br link show type can` lists them");
  if (pending_error(socket) == ENETDOWN)
    throw std::runtime_error("interface \"" + interface + "\" is down; `ip link set " + interface +
                             " up type can bitrate 1000000`");
  if (options.fd) require_fd(socket, interface);
  return socket;
}

Metadata metadata_of(msghdr& message) {
  Metadata metadata;
  for (cmsghdr* part = CMSG_FIRSTHDR(&message); part; part = CMSG_NXTHDR(&message, part)) {
    if (part->cmsg_level != SOL_SOCKET) continue;
    if (part->cmsg_type == SO_RXQ_OVFL)
      std::memcpy(&metadata.dropped, CMSG_DATA(part), sizeof metadata.dropped);
    if (part->cmsg_type != SO_TIMESTAMPING) continue;
    scm_timestamping stamps;
    std::memcpy(&stamps, CMSG_DATA(part), sizeof stamps);
    metadata.kernel_ns = to_ns(timespec{stamps.ts[0].tv_sec, stamps.ts[0].tv_nsec});
    metadata.hardware_ns = to_ns(timespec{stamps.ts[2].tv_sec, stamps.ts[2].tv_nsec});
  }
  return metadata;
}

Batch::Batch() {
  for (std::size_t i = 0; i < size; ++i) {
    parts_[i] = {&frames[i], sizeof frames[i]};
    messages[i].msg_hdr.msg_iov = &parts_[i];
    messages[i].msg_hdr.msg_iovlen = 1;
  }
}

void Batch::lend() {
  for (std::size_t i = 0; i < size; ++i) {
    parts_[i].iov_len = sizeof frames[i];
    messages[i].msg_hdr.msg_control = control_[i].data();
    messages[i].msg_hdr.msg_controllen = control_bytes;
  }
}

}  // namespace erp::can
