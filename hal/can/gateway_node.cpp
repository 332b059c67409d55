#include "hal/can/gateway_node.hpp"

#include <array>
#include <cmath>

#include "firmware/core/fault_names.h"

namespace can {
namespace {

constexpr std::int64_t tick_ns = 2'000'000;     // the ECUs' period
constexpr std::int64_t late_ns = 3'000'000;     // chosen: what an ECU may lag behind the others
constexpr std::int64_t say_ns = 1'000'000'000;  // counters are said once a second at most
constexpr std::uint64_t clock_period = 50;      // ticks: 10 Hz

std::uint64_t ticks_in(double duration_s) {
  return static_cast<std::uint64_t>(std::llround(duration_s * 1e9 / tick_ns));
}

}  // namespace

GatewayNode::GatewayNode(const Params& params, const erp::Robot& robot, node::Node& node)
    : node_(node),
      bus_(erp::open_bus(params.bus)),
      gateway_(robot),
      frame_out_(node.advertise<erp::EcuFrame>()),
      clock_out_(node.advertise<erp::Clock>()),
      end_sequence_(ticks_in(node.options().duration_s)) {
  parameter_in_ = &node.subscribe<erp::EcuParameter>(
      [this](const auto& m) { send(gateway_.parameters(m)); }, 8);
  node.subscribe<erp::EcuCommand>([this](const auto& m) { on_command(m); });
  node.watch(bus_->fd(), [this] { receive(); });
  node.on_deactivate([this] { publish_clock(); });
  node.every(say_ns, [this] { say_counters(); });
  if (!node.clock().lockstep()) node.every(tick_ns, [this] { close_late_tick(); });
}

void GatewayNode::send(std::span<const erp::CanFrame> frames) { bus_->send(frames); }

void GatewayNode::on_command(const erp::EcuCommand& command) {
  // Gains sent before this command are waiting already: they go first, in every run alike.
  parameter_in_->poll(true);
  node_.count_step(gateway_.frame().stamp_ns);
  if (node_.clock().lockstep() && command.answers != gateway_.frame().sequence) return;
  send(gateway_.commands(command));
  if (end_sequence_ && command.answers >= end_sequence_) node_.finish();
}

void GatewayNode::receive() {
  std::array<erp::CanFrame, 64> frames;
  while (const auto n = bus_->receive(frames, 0))
    for (std::size_t i = 0; i < n; ++i) switch (gateway_.hear(frames[i])) {
        case erp::Heard::tick:
          publish_tick();
          break;
        case erp::Heard::tick_repeated:
          send(gateway_.again());
          break;
        case erp::Heard::nothing:
          if (!open_since_ns_) open_since_ns_ = node::monotonic_ns();
          break;
      }
  say_emergencies();
}

void GatewayNode::close_late_tick() {
  if (!open_since_ns_ || node::monotonic_ns() - *open_since_ns_ < late_ns) return;
  gateway_.close_tick();
  publish_tick();
}

void GatewayNode::publish_tick() {
  open_since_ns_.reset();
  auto& frame = gateway_.frame();
  // Simulated time begins at the first tick, as it does in the simulator itself.
  node_.clock().advance(static_cast<std::int64_t>(frame.sequence - 1) * tick_ns);
  frame.stamp_ns = node_.clock().now_ns();
  if (frame.sequence % clock_period == 1) publish_clock();
  frame_out_.publish_numbered(frame);
}

void GatewayNode::publish_clock() {
  erp::Clock clock;
  const auto sequence = gateway_.frame().sequence;
  clock.stamp_ns = sequence ? static_cast<std::int64_t>(sequence - 1) * tick_ns : 0;
  clock_out_.publish(clock);
}

void GatewayNode::say_emergencies() {
  for (const auto& emergency : gateway_.emergencies()) {
    const bool boot = emergency.said.boot;
    node_.report(boot ? erp::Severity::info : erp::Severity::fault,
                 "ecu " + std::to_string(emergency.ecu), boot ? "boot" : "emergency",
                 boot ? "the ECU has started" : ecu_fault_name(emergency.said.fault));
  }
  gateway_.clear_emergencies();
}

void GatewayNode::say_counters() {
  const auto now = gateway_.counters();
  const auto say = [&](std::uint64_t count, std::uint64_t before, const char* what) {
    if (count > before)
      node_.report(erp::Severity::warning, "bus", what,
                   std::to_string(count - before) + " " + what + " more, " + std::to_string(count) +
                       " in all");
  };
  say(now.corrupt, said_.corrupt, "corrupt_frames");
  say(now.lost, said_.lost, "lost_frames");
  say(now.foreign, said_.foreign, "foreign_frames");
  say(now.incomplete_ticks, said_.incomplete_ticks, "incomplete_ticks");
  say(bus_->counters().refused, refused_said_, "transmit_queue_full");
  said_ = now;
  refused_said_ = bus_->counters().refused;
}

}  // namespace can
