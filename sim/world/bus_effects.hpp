#pragma once
#include <cstdint>
#include <deque>

#include "interfaces/topics.hpp"
#include "sim/model/actuator/noise.hpp"
#include "sim/model/effects/acting.hpp"

/// The bus between plant and ECUs, with its effects. Commands and frames arrive in the order in
/// which they were sent, each after its delay. Until a frame arrives, the previous one remains
/// valid.
namespace sim {

class BusEffects {
 public:
  BusEffects() = default;
  BusEffects(effects::Acting acting, std::uint64_t seed)
      : acting_(std::move(acting)), random_(seed) {}
  /// True: no effect acts, and commands and frames need not pass through this class.
  bool empty() const { return acting_.empty(); }

  /// Sends a command, at the time of the last frame sent.
  void send(const erp::EcuCommand& command);
  /// The next command that has arrived, valid until the next call; null: none.
  const erp::EcuCommand* arrived(double time_s);

  /// Sends a frame.
  void send_frame(const erp::EcuFrame& frame, double time_s);
  /// The newest frame that has arrived, or the first one ever sent.
  const erp::EcuFrame& newest_frame() const { return frames_.front().message; }

 private:
  template <class Message>
  struct InTransit {
    double due_s;
    Message message;
  };
  template <class Message>
  void enqueue(std::deque<InTransit<Message>>& queue, double due_s, const Message& message) {
    queue.push_back({queue.empty() ? due_s : std::max(due_s, queue.back().due_s), message});
  }
  effects::Acting acting_;
  Noise random_{0};
  double now_s_ = 0;
  std::deque<InTransit<erp::EcuCommand>> commands_;
  erp::EcuCommand current_;
  std::deque<InTransit<erp::EcuFrame>> frames_;
};

}  // namespace sim
