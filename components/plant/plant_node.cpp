#include "components/plant/plant_node.hpp"

#include <algorithm>
#include <cmath>

namespace plant {
namespace {

constexpr std::int64_t device_check_ns = 1'000'000;  // device_lost follows 50 … 51 ms of silence
constexpr std::uint64_t owner_period_frames = 50;    // owners are published at 10 Hz
constexpr std::uint64_t gains_period_frames = 50;    // between attempts to set gains
constexpr std::size_t max_answers = 64;              // chosen: controllers that lockstep waits for

}  // namespace

PlantNode::PlantNode(const Params& params, const erp::Robot& robot, node::Node& node)
    : node_(node),
      plant_(params, robot),
      sensor_out_(node.advertise<erp::SensorFrame>()),
      ecu_out_(node.advertise<erp::EcuCommand>()),
      parameter_out_(node.advertise<erp::EcuParameter>()),
      owner_out_(node.advertise<erp::ActuatorOwner>()) {
  command_in_ = &node.subscribe<erp::ActuatorCommand>([this](const auto& m) { on_command(m); });
  node.subscribe<erp::GainCommand>([this](const auto& m) { plant_.receive(m), send_gains(false); });
  node.subscribe<erp::EcuFrame>([this](const auto& m) { on_frame(m); });
  node.every(device_check_ns, [this] {
    if (node_.clock().lockstep() ? answer_pending_ && all_answered()
                                 : plant_.check_device(node_.clock().elapsed_ns()))
      answer();
  });
}

void PlantNode::on_frame(const erp::EcuFrame& frame) {
  if (answer_pending_ && !node_.clock().lockstep()) answer();
  // A lockstep device repeats a frame whose answer it missed.
  if (frame_received_ && node_.clock().lockstep() && frame.sequence == current_frame_)
    return repeat_answer();
  node_.clock().advance(frame.stamp_ns);
  current_frame_ = frame.sequence;
  frame_received_ = true;
  answer_pending_ = true;
  pending_since_ns_ = node::monotonic_ns();
  auto sensed = plant_.sense(frame, node_.clock().elapsed_ns());
  sensor_out_.publish_numbered(sensed);
  send_gains(frame_count_++ % gains_period_frames == 0);
  if (frame_count_ % owner_period_frames == 1) publish_owners();
  node_.count_step(frame.stamp_ns);
  if (node_.clock().lockstep() && all_answered()) answer();
}

void PlantNode::on_command(const erp::ActuatorCommand& command) {
  plant_.receive(command, node_.clock().elapsed_ns());
  if (node_.clock().lockstep()) store_answer(command);
  if (!answer_pending_) {
    if (!node_.clock().lockstep() && frame_received_) answer();
    return;
  }
  if (!node_.clock().lockstep() || all_answered()) answer();
}

/// If the list is full, the controller that has been silent for the most frames loses its place.
void PlantNode::store_answer(const erp::ActuatorCommand& command) {
  auto place = std::ranges::find(answers_, command.controller, &Answer::controller);
  if (place == answers_.end())
    place = answers_.size() < max_answers
                ? answers_.insert(place, Answer{})
                : std::ranges::min_element(answers_, {}, &Answer::answers);
  *place = {command.controller, command.answers};
}

bool PlantNode::all_answered() const {
  const auto answered = static_cast<std::size_t>(
      std::count_if(answers_.begin(), answers_.end(),
                    [&](const Answer& a) { return a.answers >= current_frame_; }));
  return answered >= command_in_->matched() ||
         node::monotonic_ns() - pending_since_ns_ > node::lockstep_timeout_ns;
}

void PlantNode::answer() {
  auto command = plant_.command(node_.clock().elapsed_ns());
  command.stamp_ns = node_.clock().stamp_ns();
  ecu_out_.publish(command);
  answer_pending_ = false;
  report_notices();
}

void PlantNode::repeat_answer() {
  if (!answer_pending_) answer();
}

void PlantNode::send_gains(bool load) {
  auto parameters = plant_.gains(node_.clock().elapsed_ns(), load);
  if (!parameters.values._length) return;
  parameters.stamp_ns = node_.clock().stamp_ns();
  parameter_out_.publish(parameters);
}

void PlantNode::report_notices() {
  for (const auto& notice : plant_.take_notices())
    node_.report(notice.severity, notice.subject, notice.code, notice.text);
}

void PlantNode::publish_owners() {
  auto owners = plant_.owners();
  owner_out_.publish(owners);
}

}  // namespace plant
