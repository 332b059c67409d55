#include "components/sim/sim_node.hpp"

#include <cmath>
#include <stdexcept>

#include "firmware/core/ecu.h"
#include "interfaces/xml/values.hpp"

namespace sim {
namespace {

constexpr std::int64_t tick_ns = 2'000'000;            // the ECUs' period
constexpr std::int64_t max_catch_up_ns = 200'000'000;  // chosen: longest delay that is caught up
constexpr std::int64_t repeat_ns = 200'000'000;  // chosen: lockstep, time until a frame is repeated
constexpr std::uint64_t pose_period_ticks = 10;  // body poses at 50 Hz
constexpr std::uint64_t clock_period_ticks = 50;  // 10 Hz

constexpr double tick_s = 1e-9 * tick_ns;

int substeps_of(const SimNode::Params& params) {
  const int substeps = static_cast<int>(std::lround(params.physics_Hz * tick_s));
  if (std::abs(substeps / tick_s - params.physics_Hz) > 1e-6)
    throw std::invalid_argument("physics_Hz=" + xml::write_number(params.physics_Hz) +
                                " is not a multiple of 500; give 500, 1000, 1500 …");
  return substeps;
}

WorldOptions world_options(const SimNode::Params& params) {
  WorldOptions options;
  options.usual_step_s = tick_s / substeps_of(params);
  for (const auto& lock : params.locks) options.lock.push_back(lock.joint);
  return options;
}

VirtualEcuOptions ecu_options(const SimNode::Params& params) {
  VirtualEcuOptions options;
  options.substeps = substeps_of(params);
  options.seed = static_cast<std::uint64_t>(params.seed);
  options.zeros_known = params.zeros == Zeros::known;
  return options;
}

std::uint64_t ticks_in(double duration_s) {
  return duration_s > 0 ? static_cast<std::uint64_t>(std::llround(duration_s * 1e9 / tick_ns)) : 0;
}

}  // namespace

SimNode::SimNode(const Params& params, const erp::Robot& robot, node::Node& node)
    : node_(node),
      world_(robot, world_options(params)),
      faults_(params.faults, robot),
      loads_(params.loads, world_),
      ecus_(robot, ecu_options(params)),
      imus_(world_, static_cast<std::uint64_t>(params.seed), tick_s),
      joints_out_(node.advertise<erp::JointState>()),
      bodies_out_(node.advertise<erp::BodyPose>()),
      end_ticks_(ticks_in(node.options().duration_s)) {
  if (faults_.needs_separate_ecus() && !params.has_external_ecus())
    throw std::invalid_argument(
        "the faults hang, busy and bus_off need ECUs that run as separate programs: "
        "give converter_port, and start `ecu`");
  if (faults_.has(FaultKind::reset) && params.has_external_ecus())
    throw std::invalid_argument(
        "the fault reset needs virtual ECUs; end the process `ecu` of a separate one instead");
  if (!faults_.empty()) ecus_.inject(&faults_);
  if (params.has_external_ecus()) serve_external(params, robot);
  else if (params.bus.empty()) join_bus_as_device();
  else open_bus_front(params.bus, robot);
  if (!bus_ && !external_) clock_out_ = &node.advertise<erp::Clock>();
  if (!robot.imus.empty()) imus_out_ = &node.advertise<erp::ImuFrame>();
  erp::assign(imu_frame_.robot, robot.name);
  erp::assign(imu_frame_.source, "sim");
  node.on_activate([this] {
    activated_ns_ = node::monotonic_ns();
    ecus_.measure(world_);
    if (external_) external_->measure(world_);
    if (bus_) bus_->send_boot();
    measure_and_publish();
  });
  node.on_deactivate([this] { publish_clock(at_end()); });
  if (node.clock().lockstep())
    node.every(repeat_ns, [this] {
      if (!external_ && node::monotonic_ns() - published_ns_ > repeat_ns) repeat_frame();
    });
  else
    node.every(
        tick_ns / steps_per_tick(), [this] { step(); }, external_ ? 0 : max_catch_up_ns);
}

void SimNode::join_bus_as_device() {
  frame_out_ = &node_.advertise<erp::EcuFrame>();
  parameter_in_ =
      &node_.subscribe<erp::EcuParameter>([this](const auto& m) { ecus_.receive(m); }, 8);
  node_.subscribe<erp::EcuCommand>([this](const auto& m) { on_command(m); });
}

void SimNode::open_bus_front(const std::string& bus, const erp::Robot& robot) {
  bus_ = std::make_unique<BusFront>(bus, robot, ecus_);
  for (std::size_t k = 0; k < bus_->buses(); ++k)
    node_.watch(bus_->descriptor(k), [this, k] {
      const bool answered = bus_->receive(k);
      if (answered && node_.clock().lockstep()) tick();
    });
}

void SimNode::serve_external(const Params& params, const erp::Robot& robot) {
  ExternalEcus::Options options{params.converter_port, params.converter_lines};
  options.seed = static_cast<std::uint64_t>(params.seed);
  options.lockstep = node_.clock().lockstep();
  external_ = std::make_unique<ExternalEcus>(robot, options);
  if (!faults_.empty()) external_->inject(&faults_);
  for (const int descriptor : external_->descriptors())
    node_.watch(descriptor, [this] { receive_external(); });
}

/// In lockstep the world advances when every ECU has requested the next readings.
void SimNode::receive_external() {
  if (!external_->receive()) return;
  for (int k = 0; k < steps_per_tick(); ++k) step();
  if (!at_end()) external_->begin_turn();
}

/// Reports changes of the number of connected external ECUs.
void SimNode::report_external() {
  const int alive = external_->alive();
  if (alive == alive_reported_) return;
  node_.report(alive > alive_reported_ ? erp::Severity::info : erp::Severity::warning, "ecus",
               "external_ecus",
               std::to_string(alive) + " of " + std::to_string(world_.robot().ecus().size()) +
                   " ECUs are connected");
  alive_reported_ = alive;
}

void SimNode::on_command(const erp::EcuCommand& command) {
  // Gains published before this command are in the queue. They are applied first, in every run.
  parameter_in_->poll(true);
  if (!node_.clock().lockstep()) return ecus_.receive(command);
  if (command.answers != frame_.sequence) return;
  ecus_.receive(command);
  tick();
}

/// With external ECUs the world advances in steps between their periods. They cannot run faster
/// after a delay, so the world does not run faster either.
int SimNode::steps_per_tick() const { return external_ ? ExternalEcus::steps_per_tick : 1; }

void SimNode::step() {
  if (external_ && !external_->step(world_)) return;
  if (++steps_ % steps_per_tick() == 0) tick();
}

void SimNode::begin_faults() {
  for (const auto& [fault, ecu] : faults_.beginning(world_.time_s(), tick_s)) {
    node_.report(erp::Severity::info, fault->on, "fault_injected",
                 xml::Codec<FaultKind>::write(fault->kind));
    if (fault->kind != FaultKind::reset) continue;
    ecus_.reset(ecu);
    if (bus_) bus_->reset(ecu);
  }
}

void SimNode::tick() {
  node_.count_step(frame_.stamp_ns);
  begin_faults();
  for (const AttachedLoad* load : loads_.update(world_))
    node_.report(erp::Severity::info, load->body,
                 load->is_attached(world_.time_s()) ? "load_attached" : "load_detached",
                 (load->is_attached(world_.time_s()) ? "attached " : "detached ") +
                     xml::Codec<double>::write(load->mass_kg) + " kg");
  if (external_) report_external();
  else ecus_.tick(world_);
  check_world();
  ++ticks_;
  if (at_end()) node_.finish();
  else measure_and_publish();
}

void SimNode::measure_and_publish() {
  node_.clock().advance(static_cast<std::int64_t>(ticks_) * tick_ns);
  frame_.sequence = ticks_;
  frame_.stamp_ns = node_.clock().stamp_ns();
  if (!external_)
    ecus_.fill(frame_), publish_frame();  // published first: the control loop waits for it
  publish_truth();
  publish_imus();
  if (ticks_ % clock_period_ticks == 0) publish_clock(false);
}

void SimNode::publish_frame() {
  published_ns_ = node::monotonic_ns();
  if (bus_) bus_->send_tick(frame_);
  else frame_out_->publish_numbered(frame_);
}

void SimNode::repeat_frame() {
  published_ns_ = node::monotonic_ns();
  if (bus_) bus_->repeat_tick();
  else frame_out_->publish_numbered(frame_);
}

void SimNode::publish_truth() {
  world_.fill(joints_);
  joints_.stamp_ns = frame_.stamp_ns;
  joints_.sequence = frame_.sequence;
  joints_out_.publish_numbered(joints_);
  if (ticks_ % pose_period_ticks) return;
  world_.fill(bodies_);
  bodies_.stamp_ns = frame_.stamp_ns;
  bodies_out_.publish(bodies_);
}

void SimNode::publish_imus() {
  if (!imus_out_) return;
  imus_.sample(world_);
  while (imus_.next(imu_frame_)) imus_out_->publish(imu_frame_);
}

void SimNode::report_once(std::size_t actuator, const std::string& code, const std::string& text) {
  if (!reported_.emplace(actuator, code).second) return;
  const auto& actuators = world_.robot().actuators;
  node_.report(erp::Severity::warning, actuator < actuators.size() ? actuators[actuator].name : "",
               code, text);
}

/// Reports numerical problems once each; ends the simulation if velocities are not finite.
void SimNode::check_world() {
  const std::size_t count = world_.robot().actuators.size();
  for (std::size_t k = 0; k < count; ++k) {
    const Rope* rope = world_.rope(static_cast<int>(k));
    if (rope && rope->failed_steps() > 0)
      report_once(
          k, "rope_unstable",
          "the rope did not converge within a step: this tendon is unreliable from now on; give "
          "it a softer line or a shorter step (physics_Hz), or remove <rope>");
    if (!rope && world_.path(static_cast<int>(k)).penetrated_pulley() >= 0)
      report_once(
          k, "point_in_pulley",
          "a point of its path entered the adjacent pulley, which the path now bypasses: the "
          "tendon length has jumped; move the point or the pulley");
  }
  if (world_.unconverged_steps() > 0)
    report_once(count, "step_unsettled",
                "the forces of a step did not converge; give a shorter step (physics_Hz)");
  if (world_.is_finite()) return;
  node_.report(
      erp::Severity::fault, "", "not_finite",
      "the velocities are not finite; the simulation ends; give a shorter step (physics_Hz)");
  node_.finish(1);
}

/// On CAN buses the gateway is the device and publishes the clock.
void SimNode::publish_clock(bool finished) {
  if (!clock_out_) return;
  erp::Clock clock;
  clock.stamp_ns = static_cast<std::int64_t>(ticks_) * tick_ns;
  const auto elapsed_ns = node::monotonic_ns() - activated_ns_;
  clock.real_time_factor =
      elapsed_ns > 0 ? static_cast<double>(clock.stamp_ns) / static_cast<double>(elapsed_ns) : 0;
  clock.finished = finished;
  clock_out_->publish(clock);
}

}  // namespace sim
