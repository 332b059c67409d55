#include "components/gateway/gateway_node.hpp"

#include <array>
#include <cmath>
#include <filesystem>

#include "firmware/core/bundle.h"
#include "hal/can/load.hpp"

namespace can {
namespace {

constexpr std::int64_t tick_ns = 2'000'000;  // the ECUs' period
constexpr std::int64_t tick_timeout_ns =
    3'000'000;                                    // chosen: largest lag of an ECU behind the others
constexpr std::int64_t supervise_ns = 1'000'000;  // chosen: period of bus supervision
constexpr std::int64_t report_ns = 1'000'000'000;  // counters are reported at most once a second
constexpr std::int64_t discover_ns = 100'000'000;  // chosen: period of DISCOVER
constexpr int discovers_per_report = 11;           // chosen: unanswered for 1 s
constexpr std::uint64_t clock_period_ticks = 50;   // 10 Hz
constexpr std::size_t frames_in_flight = 2;        // chosen: per ECU

std::uint64_t ticks_in(double duration_s) {
  return static_cast<std::uint64_t>(std::llround(duration_s * 1e9 / tick_ns));
}

std::vector<std::string> actuators_by_ecu(const erp::Robot& robot) {
  std::vector<std::string> names(FRAME_ECUS);
  for (const erp::Actuator& actuator : robot.actuators) {
    std::string& list = names[static_cast<std::size_t>(actuator.ecu)];
    list += (list.empty() ? "" : ", ") + actuator.name;
  }
  return names;
}

std::string trace_name(const std::string& file, const std::string& bus, std::size_t buses) {
  if (buses == 1) return file;
  std::filesystem::path path(file);
  return path.replace_filename(path.stem().string() + "." + bus + path.extension().string());
}

constexpr std::size_t frames_per_bundle = 4;  // assumed for the load of CAN FD

/// Worst-case time of a frame on its bus.
double worst_frame_time_s(const erp::BusPlan& plan) {
  if (!plan.data_bitrate_per_s) return erp::frame_time_s(8, plan.bitrate_per_s);
  const std::size_t bytes = bundle_size(frames_per_bundle);
  return erp::fd_frame_time_s(bytes, plan.bitrate_per_s, *plan.data_bitrate_per_s) /
         frames_per_bundle;
}

}  // namespace

GatewayNode::GatewayNode(const Params& params, const erp::Robot& robot, node::Node& node)
    : node_(node),
      routes_(robot),
      gateway_(robot),
      ecus_(robot.ecus()),
      actuators_on_(actuators_by_ecu(robot)),
      frame_out_(node.advertise<erp::EcuFrame>()),
      clock_out_(node.advertise<erp::Clock>()),
      end_sequence_(ticks_in(node.options().duration_s)) {
  open(params, robot);
  parameter_in_ = &node.subscribe<erp::EcuParameter>(
      [this](const auto& m) { send(gateway_.parameters(m)); }, 8);
  node.subscribe<erp::EcuCommand>([this](const auto& m) { on_command(m); });
  for (erp::BusKeeper& bus : buses_) node.watch(bus.bus().fd(), [this, &bus] { receive(bus); });
  node.on_activate([this] {
    activated_ns_ = node::monotonic_ns();
    discover();
  });
  node.on_deactivate([this] { publish_clock(); });
  node.every(report_ns, [this] { report_counters(); });
  node.every(discover_ns, [this] { discover(); });
  node.every(supervise_ns, [this] { supervise(); });
  if (!node.clock().lockstep()) node.every(tick_ns, [this] { close_overdue_tick(); });
}

void GatewayNode::open(const Params& params, const erp::Robot& robot) {
  erp::refuse_overload(robot);
  auto opened = erp::open_buses(robot, params.bus, frames_in_flight);
  buses_.reserve(opened.size());
  for (std::size_t k = 0; k < opened.size(); ++k) {
    buses_.emplace_back(routes_.name(k), std::move(opened[k]));
    if (!params.trace.empty())
      buses_[k].record(trace_name(params.trace, routes_.name(k), opened.size()));
  }
  for (const erp::BusPlan& plan : robot.buses()) frame_time_s_.push_back(worst_frame_time_s(plan));
  unsent_reported_.assign(buses_.size(), 0);
  unrecorded_reported_.assign(buses_.size(), 0);
  frames_before_.assign(buses_.size(), 0);
}

std::int64_t GatewayNode::now_ns() const {
  return node_.clock().lockstep() ? 0 : node::monotonic_ns();
}

void GatewayNode::send(std::span<const erp::CanFrame> frames) {
  if (buses_.size() == 1) return buses_[0].post(frames, now_ns());
  routes_.sort(frames);
  for (std::size_t k = 0; k < buses_.size(); ++k) buses_[k].post(routes_.on(k), now_ns());
}

void GatewayNode::on_command(const erp::EcuCommand& command) {
  // Gains published before this command are in the queue. They are sent first, in every run.
  parameter_in_->poll(true);
  node_.count_step(gateway_.frame().stamp_ns);
  if (node_.clock().lockstep() && command.answers != gateway_.frame().sequence) return;
  send(gateway_.commands(command));
  if (end_sequence_ && command.answers >= end_sequence_) node_.finish();
}

void GatewayNode::receive(erp::BusKeeper& bus) {
  std::array<erp::CanFrame, 64> frames;
  while (const auto n = bus.bus().receive(frames, 0))
    for (const erp::CanFrame& frame : std::span(frames).first(n)) {
      const auto ecu = frame_ecu_of(&frame);
      if (gateway_.is_compatible(ecu)) watch_.received(ecu, now_ns());
      switch (gateway_.receive(frame)) {
        case erp::FrameResult::tick:
          on_tick_complete();
          break;
        case erp::FrameResult::tick_repeated:
          send(gateway_.repeat());
          break;
        case erp::FrameResult::nothing:
          if (!open_since_ns_) open_since_ns_ = node::monotonic_ns();
          break;
      }
    }
  if (tick_pending_) publish_tick();
  bus.flush(now_ns());
  report_events();
}

/// If several ticks are pending because this process was delayed, only the newest is published; in
/// lockstep there is never more than one.
void GatewayNode::on_tick_complete() {
  ticks_skipped_ += tick_pending_;
  tick_pending_ = true;
  if (node_.clock().lockstep()) publish_tick();
}

void GatewayNode::supervise() {
  for (erp::BusKeeper& bus : buses_)
    for (const auto& notice : bus.supervise(now_ns()))
      node_.report(notice.severity, bus.name(), notice.code, notice.text);
  if (node_.clock().lockstep()) return;  // ECUs have no deadline in lockstep
  // Reads all waiting frames before ECUs are evaluated, because this process may have been delayed.
  const auto evaluation_ns = now_ns();
  for (erp::BusKeeper& bus : buses_) receive(bus);
  watch_.step(evaluation_ns,
              [this](int ecu, erp::EcuWatch::Event event) { report_ecu(ecu, event); });
}

/// Sends DISCOVER until all ECUs have answered.
void GatewayNode::discover() {
  const auto is_identified = [this](int ecu) { return gateway_.is_identified(ecu); };
  if (std::ranges::all_of(ecus_, is_identified)) return;
  send(gateway_.discover());
  if (++discovers_sent_ == discovers_per_report) report_unanswered();
}

void GatewayNode::close_overdue_tick() {
  if (!open_since_ns_ || node::monotonic_ns() - *open_since_ns_ < tick_timeout_ns) return;
  gateway_.close_tick();
  publish_tick();
}

void GatewayNode::publish_tick() {
  tick_pending_ = false;
  open_since_ns_.reset();
  auto& frame = gateway_.frame();
  // Simulated time starts at the first tick, as in the simulator.
  node_.clock().advance(static_cast<std::int64_t>(frame.sequence - 1) * tick_ns);
  frame.stamp_ns = node_.clock().stamp_ns();
  if (frame.sequence % clock_period_ticks == 1) publish_clock();
  frame_out_.publish_numbered(frame);
}

void GatewayNode::publish_clock() {
  erp::Clock clock;
  const auto sequence = gateway_.frame().sequence;
  clock.stamp_ns = sequence ? static_cast<std::int64_t>(sequence - 1) * tick_ns : 0;
  const auto elapsed_ns = node::monotonic_ns() - activated_ns_;
  clock.real_time_factor =
      elapsed_ns > 0 ? static_cast<double>(clock.stamp_ns) / static_cast<double>(elapsed_ns) : 0;
  clock_out_.publish(clock);
}

}  // namespace can
