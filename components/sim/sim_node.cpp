#include "components/sim/sim_node.hpp"

#include <cmath>
#include <stdexcept>

#include "firmware/core/ecu.h"
#include "interfaces/xml/values.hpp"

namespace sim {
namespace {

constexpr std::int64_t tick_ns = 2'000'000;       // the ECUs' period
constexpr std::int64_t make_up_ns = 200'000'000;  // chosen: realtime, lateness worth making up
constexpr std::int64_t repeat_ns = 200'000'000;   // chosen: lockstep, for an answer that got lost
constexpr std::uint64_t pose_period = 10;         // ticks: pictures at 50 Hz
constexpr std::uint64_t clock_period = 50;        // ticks: 10 Hz

constexpr double tick_s = 1e-9 * tick_ns;

int substeps_of(const SimNode::Params& params) {
  const int substeps = static_cast<int>(std::lround(params.physics_Hz * tick_s));
  if (std::abs(substeps / tick_s - params.physics_Hz) > 1e-6)
    throw std::invalid_argument("physics_Hz=" + xml::write_number(params.physics_Hz) +
                                " is no multiple of 500; give 500, 1000, 1500 …");
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
  return options;
}

std::uint64_t ticks_in(double duration_s) {
  return duration_s > 0 ? static_cast<std::uint64_t>(std::llround(duration_s * 1e9 / tick_ns)) : 0;
}

}  // namespace

SimNode::SimNode(const Params& params, const erp::Robot& robot, node::Node& node)
    : node_(node),
      world_(robot, world_options(params)),
      mishaps_(params.mishaps, robot),
      grasps_(params.grasps, world_),
      ecus_(robot, ecu_options(params)),
      imus_(world_, static_cast<std::uint64_t>(params.seed), tick_s),
      joints_out_(node.advertise<erp::JointState>()),
      bodies_out_(node.advertise<erp::BodyPose>()),
      end_ticks_(ticks_in(node.options().duration_s)) {
  if (mishaps_.needs_separate_ecus() && !params.ecus_outside())
    throw std::invalid_argument(
        "hang, busy and bus_off befall ECUs that are programs of their own: give converter_port, "
        "and start `ecu`");
  if (!mishaps_.empty()) ecus_.suffer(&mishaps_);
  if (params.ecus_outside()) serve_outside(params, robot);
  else if (params.bus.empty()) join_bus_as_device();
  else stand_behind(params.bus, robot);
  if (!bus_ && !outside_) clock_out_ = &node.advertise<erp::Clock>();
  if (!robot.imus.empty()) imus_out_ = &node.advertise<erp::ImuFrame>();
  erp::assign(imu_frame_.robot, robot.name);
  erp::assign(imu_frame_.source, "sim");
  node.on_activate([this] {
    began_ns_ = node::monotonic_ns();
    ecus_.measure(world_);
    if (outside_) outside_->measure(world_);
    if (bus_) bus_->say_boot();
    measure_and_say();
  });
  node.on_deactivate([this] { publish_clock(at_end()); });
  if (node.clock().lockstep())
    node.every(repeat_ns, [this] {
      if (!outside_ && node::monotonic_ns() - said_ns_ > repeat_ns) say_again();
    });
  else
    node.every(
        tick_ns / steps_a_tick(), [this] { step(); }, outside_ ? 0 : make_up_ns);
}

void SimNode::join_bus_as_device() {
  frame_out_ = &node_.advertise<erp::EcuFrame>();
  parameter_in_ =
      &node_.subscribe<erp::EcuParameter>([this](const auto& m) { ecus_.accept(m); }, 8);
  node_.subscribe<erp::EcuCommand>([this](const auto& m) { on_command(m); });
}

void SimNode::stand_behind(const std::string& bus, const erp::Robot& robot) {
  bus_ = std::make_unique<BusFront>(bus, robot, ecus_);
  for (std::size_t k = 0; k < bus_->buses(); ++k)
    node_.watch(bus_->descriptor(k), [this, k] {
      const bool answered = bus_->hear(k);
      if (answered && node_.clock().lockstep()) tick();
    });
}

void SimNode::serve_outside(const Params& params, const erp::Robot& robot) {
  OutsideEcus::Options options{params.converter_port, params.converter_lines};
  options.seed = static_cast<std::uint64_t>(params.seed);
  options.lockstep = node_.clock().lockstep();
  outside_ = std::make_unique<OutsideEcus>(robot, options);
  if (!mishaps_.empty()) outside_->suffer(&mishaps_);
  for (const int descriptor : outside_->descriptors())
    node_.watch(descriptor, [this] { hear_outside(); });
}

/// In lockstep the world moves on when every ECU wants it to.
void SimNode::hear_outside() {
  if (!outside_->hear()) return;
  for (int k = 0; k < steps_a_tick(); ++k) step();
  if (!at_end()) outside_->begin_turn();
}

/// Who has come and who has gone, of the ECUs outside.
void SimNode::say_outside() {
  const int alive = outside_->alive();
  if (alive == alive_said_) return;
  node_.report(alive > alive_said_ ? erp::Severity::info : erp::Severity::warning, "ecus",
               "outside",
               std::to_string(alive) + " of " + std::to_string(world_.robot().ecus().size()) +
                   " ECUs are connected");
  alive_said_ = alive;
}

void SimNode::on_command(const erp::EcuCommand& command) {
  // Gains sent before this command are waiting already: they come first, in every run alike.
  parameter_in_->poll(true);
  if (!node_.clock().lockstep()) return ecus_.accept(command);
  if (command.answers != frame_.sequence) return;
  ecus_.accept(command);
  tick();
}

/// ECUs outside have the world move in steps between their periods. They cannot run faster to make
/// up for lost time with it: what they miss, it misses.
int SimNode::steps_a_tick() const { return outside_ ? OutsideEcus::steps_a_tick : 1; }

void SimNode::step() {
  if (outside_ && !outside_->step(world_)) return;
  if (++steps_ % steps_a_tick() == 0) tick();
}

void SimNode::tick() {
  node_.count_step(frame_.stamp_ns);
  for (const Mishap* begun : mishaps_.beginning(world_.time_s(), tick_s))
    node_.report(erp::Severity::info, begun->on, "mishap",
                 xml::Codec<MishapKind>::write(begun->kind));
  for (const Grasp* changed : grasps_.befall(world_))
    node_.report(erp::Severity::info, changed->body, "grasp",
                 (changed->holds(world_.time_s()) ? "takes up " : "lets go ") +
                     xml::Codec<double>::write(changed->mass_kg) + " kg");
  if (outside_) say_outside();
  else ecus_.tick(world_);
  watch_world();
  ++ticks_;
  if (at_end()) node_.finish();
  else measure_and_say();
}

void SimNode::measure_and_say() {
  node_.clock().advance(static_cast<std::int64_t>(ticks_) * tick_ns);
  frame_.sequence = ticks_;
  frame_.stamp_ns = node_.clock().now_ns();
  if (!outside_) ecus_.fill(frame_), say_frame();  // first: the control loop waits for it
  publish_truth();
  publish_imus();
  if (ticks_ % clock_period == 0) publish_clock(false);
}

void SimNode::say_frame() {
  said_ns_ = node::monotonic_ns();
  if (bus_) bus_->say(frame_);
  else frame_out_->publish_numbered(frame_);
}

void SimNode::say_again() {
  said_ns_ = node::monotonic_ns();
  if (bus_) bus_->say_again();
  else frame_out_->publish_numbered(frame_);
}

void SimNode::publish_truth() {
  world_.fill(joints_);
  joints_.stamp_ns = frame_.stamp_ns;
  joints_.sequence = frame_.sequence;
  joints_out_.publish_numbered(joints_);
  if (ticks_ % pose_period) return;
  world_.fill(bodies_);
  bodies_.stamp_ns = frame_.stamp_ns;
  bodies_out_.publish(bodies_);
}

void SimNode::publish_imus() {
  if (!imus_out_) return;
  imus_.look(world_);
  while (imus_.next(imu_frame_)) imus_out_->publish(imu_frame_);
}

void SimNode::say_once(std::size_t actuator, const std::string& code, const std::string& text) {
  if (!said_.emplace(actuator, code).second) return;
  const auto& actuators = world_.robot().actuators;
  node_.report(erp::Severity::warning, actuator < actuators.size() ? actuators[actuator].name : "",
               code, text);
}

/// What the simulation cannot do, said once; without finite velocities it ends.
void SimNode::watch_world() {
  const std::size_t count = world_.robot().actuators.size();
  for (std::size_t k = 0; k < count; ++k) {
    const Rope* rope = world_.rope(static_cast<int>(k));
    if (rope && rope->troubles() > 0)
      say_once(k, "rope_unstable",
               "the rope did not come to rest within a step: do not trust this tendon from here "
               "on; give it a softer line, a shorter step (physics_Hz), or remove <rope>");
    if (!rope && world_.path(static_cast<int>(k)).pierced() >= 0)
      say_once(k, "point_in_pulley",
               "a point of its path came inside the pulley beside it, which it now passes by: the "
               "tendon's length has leapt; move the point or the pulley");
  }
  if (world_.unsettled() > 0)
    say_once(count, "step_unsettled", "the forces of a step did not settle; give a shorter step");
  if (world_.sound()) return;
  node_.report(erp::Severity::fault, "", "not_finite",
               "the velocities are no longer finite numbers; the simulation ends");
  node_.finish(1);
}

/// Behind a bus the gateway is the device, whose time counts.
void SimNode::publish_clock(bool finished) {
  if (!clock_out_) return;
  erp::Clock clock;
  clock.stamp_ns = static_cast<std::int64_t>(ticks_) * tick_ns;
  const auto elapsed_ns = node::monotonic_ns() - began_ns_;
  clock.real_time_factor =
      elapsed_ns > 0 ? static_cast<double>(clock.stamp_ns) / static_cast<double>(elapsed_ns) : 0;
  clock.finished = finished;
  clock_out_->publish(clock);
}

}  // namespace sim
