#include <linux/can.h>
#include <linux/can/error.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "firmware/core/bundle.h"
#include "hal/can/interface.hpp"
#include "hal/can/socketcan_socket.hpp"
#include "hal/can/stamp_clock.hpp"

namespace erp::can {
namespace {

/// State of the bus after an error frame of the controller (linux/can/error.h).
BusState state_after(const can_frame& error, BusState previous) {
  if (error.can_id & CAN_ERR_BUSOFF) return BusState::off;
  if (error.can_id & CAN_ERR_RESTARTED) return BusState::active;
  if (!(error.can_id & CAN_ERR_CRTL) || previous == BusState::off) return previous;
  const auto has = [&](int bits) { return (error.data[1] & bits) != 0; };
  if (has(CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_PASSIVE)) return BusState::passive;
  if (has(CAN_ERR_CRTL_RX_WARNING | CAN_ERR_CRTL_TX_WARNING)) return BusState::warning;
  return has(CAN_ERR_CRTL_ACTIVE) ? BusState::active : previous;
}

class SocketCanBus final : public CanBus {
 public:
  SocketCanBus(const std::string& interface, const BusOptions& options)
      : interface_(interface), options_(options), socket_(open_raw(interface, options)) {}

  /// In bus-off the kernel accepts frames and discards them; therefore they are rejected here.
  std::size_t send(std::span<const CanFrame> frames) override {
    std::size_t taken = 0;
    while (taken < frames.size() && counters_.state != BusState::off) {
      const std::size_t accepted = send_batch(frames.subspan(taken));
      if (accepted == 0) break;
      taken += accepted;
    }
    counters_.sent += taken;
    counters_.refused += frames.size() - taken;
    return taken;
  }

  std::size_t receive(std::span<CanFrame> frames, double timeout_s) override {
    if (waiting_.empty() && !wait_readable(socket_.get(), timeout_s)) return 0;
    std::size_t filled = take_waiting(frames);
    while (filled < frames.size() && receive_batch())
      filled += take_waiting(frames.subspan(filled));
    return filled;
  }

  int fd() const override { return socket_.get(); }
  BusCounters counters() const override { return counters_; }
  std::size_t in_flight() const override { return in_flight_; }
  void record(FrameSink* sink) override { sink_ = sink; }

  void restart() override {
    restart_interface(interface_);
    enter(BusState::active);
  }

 private:
  void enter(BusState state) {
    counters_.state = state;
    if (counters_.off()) in_flight_ = 0;  // the frames in flight are lost
  }

  // ---- sending ----

  std::size_t send_batch(std::span<const CanFrame> frames) {
    std::array<std::size_t, Batch::size> parts;  // classic frames in each message
    const std::size_t room = room_in_flight();
    std::size_t count = 0, packed = 0;
    for (; count < std::min(room, Batch::size) && packed < frames.size(); ++count) {
      parts[count] = pack(frames.subspan(packed), count);
      packed += parts[count];
    }
    const int sent = ::sendmmsg(socket_.get(), outgoing_.messages.data(),
                                static_cast<unsigned>(count), MSG_DONTWAIT);
    if (sent < 0 && errno == ENETDOWN) enter(BusState::down);
    if (sent <= 0) return 0;  // ENOBUFS, EAGAIN: the queue is full
    if (counters_.state == BusState::down) enter(BusState::active);
    in_flight_ += static_cast<std::size_t>(sent);
    std::size_t taken = 0;
    for (int i = 0; i < sent; ++i) taken += parts[static_cast<std::size_t>(i)];
    return taken;
  }

  std::size_t room_in_flight() const {
    if (options_.window == 0) return Batch::size;
    return options_.window - std::min(options_.window, in_flight_);
  }

  /// Fills message `i`; returns how many frames it contains.
  std::size_t pack(std::span<const CanFrame> frames, std::size_t i) {
    canfd_frame& out = outgoing_.frames[i];
    out.flags = 0;
    if (!options_.fd) {
      out.can_id = frames[0].id;
      out.len = std::min<std::uint8_t>(frames[0].size, CAN_MAX_DLEN);
      std::memcpy(out.data, frames[0].data, CAN_MAX_DLEN);
      outgoing_.set_size(i, CAN_MTU);
      return 1;
    }
    bus_bundle bundle;
    const unsigned count =
        bundle_pack(&bundle, frames.data(),
                    static_cast<unsigned>(std::min<std::size_t>(frames.size(), BUNDLE_FRAMES_MAX)));
    out.can_id = bundle.id;
    out.len = bundle.size;
    out.flags = CANFD_BRS;
    std::memcpy(out.data, bundle.data, sizeof out.data);
    outgoing_.set_size(i, CANFD_MTU);
    return count;
  }

  // ---- receiving ----

  bool receive_batch() {
    incoming_.lend();
    const int count =
        ::recvmmsg(socket_.get(), incoming_.messages.data(), Batch::size, MSG_DONTWAIT, nullptr);
    if (count < 0 && errno == ENETDOWN) enter(BusState::down);
    std::size_t filled = 0;
    for (int i = 0; i < count; ++i) take(static_cast<std::size_t>(i), filled);
    waiting_ = std::span(storage_).first(filled);
    return count > 0;
  }

  void take(std::size_t i, std::size_t& filled) {
    msghdr& message = incoming_.messages[i].msg_hdr;
    const canfd_frame& in = incoming_.frames[i];
    if (in.can_id & CAN_ERR_FLAG) return take_error(in);
    const Metadata metadata = metadata_of(message);
    if (metadata.dropped != counters_.overrun)
      in_flight_ = 0;  // confirmations may have been dropped
    counters_.overrun = metadata.dropped;
    const bool is_own = (message.msg_flags & MSG_CONFIRM) != 0;
    if (is_own && in_flight_ > 0) --in_flight_;
    const auto frames = std::span(storage_).subspan(filled);
    const std::size_t count = read(in, incoming_.messages[i].msg_len, frames);
    if (sink_)
      for (const CanFrame& frame : frames.first(count))
        sink_->frame(frame, clock_.stamp_ns(metadata.kernel_ns, metadata.hardware_ns), is_own);
    if (is_own) return;
    if (counters_.off()) enter(BusState::active);  // a received frame proves that the bus works
    counters_.received += count;
    counters_.unreadable += count == 0;
    filled += count;
  }

  void take_error(const canfd_frame& in) {
    can_frame error;
    std::memcpy(&error, &in, sizeof error);
    ++counters_.errors;
    counters_.unacknowledged += (error.can_id & CAN_ERR_ACK) != 0;
    enter(state_after(error, counters_.state));
  }

  /// Number of classic frames in the received message; 0: not our format.
  static std::size_t read(const canfd_frame& in, unsigned size, std::span<CanFrame> frames) {
    const auto id = static_cast<std::uint16_t>(in.can_id & CAN_SFF_MASK);
    if (size == CANFD_MTU) {
      bus_bundle bundle{id, in.len, {}};
      std::memcpy(bundle.data, in.data, sizeof bundle.data);
      return bundle_unpack(&bundle, frames.data());
    }
    if (size != CAN_MTU || in.len > CAN_MAX_DLEN) return 0;
    frames[0] = {id, in.len, {}};
    std::memcpy(frames[0].data, in.data, sizeof frames[0].data);
    return 1;
  }

  std::size_t take_waiting(std::span<CanFrame> frames) {
    const std::size_t count = std::min(frames.size(), waiting_.size());
    std::copy_n(waiting_.begin(), count, frames.begin());
    waiting_ = waiting_.subspan(count);
    return count;
  }

  std::string interface_;
  BusOptions options_;
  Descriptor socket_;
  Batch outgoing_, incoming_;
  std::array<CanFrame, Batch::size * BUNDLE_FRAMES_MAX> storage_;  ///< of the last batch
  std::span<CanFrame> waiting_;  ///< frames of storage_ that were not yet returned
  std::size_t in_flight_ = 0;
  StampClock clock_;
  FrameSink* sink_ = nullptr;
  BusCounters counters_;
};

}  // namespace

std::unique_ptr<CanBus> open_socketcan(const std::string& interface, const BusOptions& options) {
  return std::make_unique<SocketCanBus>(interface, options);
}

}  // namespace erp::can
