#include "components/replay/replay_node.hpp"

#include <algorithm>
#include <cmath>

namespace replay {
namespace {

constexpr std::int64_t poll_ns = 1'000'000;
constexpr std::int64_t repeat_ns = 200'000'000;  // chosen: lockstep, time until a frame is repeated
constexpr std::size_t clock_period_frames = 50;  // 10 Hz

/// The number of frames in a run of `duration_s`; all frames if it is 0.
std::size_t number_of_frames(const Frames& frames, double duration_s) {
  if (duration_s <= 0) return frames.size();
  const auto limit = frames.at(0).stamp_ns + std::llround(1e9 * duration_s);
  std::size_t k = 0;
  while (k < frames.size() && frames.at(k).stamp_ns < limit) ++k;
  return k;
}

}  // namespace

ReplayNode::ReplayNode(const Params& params, const erp::Robot&, node::Node& node)
    : node_(node),
      frames_(params.file),
      frame_out_(node.advertise<erp::EcuFrame>()),
      clock_out_(node.advertise<erp::Clock>()),
      end_(number_of_frames(frames_, node.options().duration_s)),
      recorded_start_ns_(frames_.at(0).stamp_ns) {
  node.on_activate([this] {
    start_ns_ = node::monotonic_ns();
    if (node_.clock().lockstep()) play_next();
  });
  node.subscribe<erp::EcuCommand>([this](const erp::EcuCommand& command) {
    node_.count_step(frame_.stamp_ns);
    if (node_.clock().lockstep() && next_ > 0 && command.answers == frame_.sequence) play_next();
  });
  if (node.clock().lockstep())
    node.every(repeat_ns, [this] {
      if (next_ > 0 && node::monotonic_ns() - published_ns_ > repeat_ns) publish_frame();
    });
  else node.every(poll_ns, [this] { play_due(); });
}

void ReplayNode::publish_frame() {
  published_ns_ = node::monotonic_ns();
  frame_out_.publish_numbered(frame_);
}

void ReplayNode::play_due() {
  while (next_ <= end_) {
    if (next_ < end_ &&
        frames_.at(next_).stamp_ns - recorded_start_ns_ > node::monotonic_ns() - start_ns_)
      return;
    play_next();
  }
}

void ReplayNode::play_next() {
  const bool finished = next_ >= end_;
  if (!finished) {
    frame_ = frames_.at(next_);
    if (node_.clock().lockstep())
      frame_.stamp_ns -= recorded_start_ns_, node_.clock().advance(frame_.stamp_ns);
    else frame_.stamp_ns = node_.clock().now_ns();
    publish_frame();
  }
  ++next_;
  if (finished || next_ % clock_period_frames == 0) {
    erp::Clock clock;
    clock.stamp_ns = frame_.stamp_ns;
    clock.finished = finished;
    clock_out_.publish(clock);
  }
  if (finished) node_.finish();
}

}  // namespace replay
