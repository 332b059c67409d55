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
  const auto limit_ns = std::llround(1e9 * duration_s);
  std::size_t k = 0;
  while (k < frames.size() && frames.since_start_ns(k) < limit_ns) ++k;
  return k;
}

}  // namespace

ReplayNode::ReplayNode(const Params& params, const erp::Robot&, node::Node& node)
    : node_(node),
      frames_(params.file),
      frame_out_(node.advertise<erp::EcuFrame>()),
      clock_out_(node.advertise<erp::Clock>()),
      end_(number_of_frames(frames_, node.options().duration_s)) {
  node.on_activate([this] {
    start_ns_ = node::monotonic_ns();
    for (const auto& step : frames_.clock_steps())
      node_.report(erp::Severity::warning, "recording", "clock_set",
                   step + "; the frames are played without this step");
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
    if (next_ < end_ && frames_.since_start_ns(next_) > node::monotonic_ns() - start_ns_) return;
    play_next();
  }
}

void ReplayNode::play_next() {
  const bool finished = next_ >= end_;
  if (!finished) {
    frame_ = frames_.at(next_);
    played_ns_ = frames_.since_start_ns(next_);
    node_.clock().advance(played_ns_);
    frame_.stamp_ns = node_.clock().stamp_ns();
    publish_frame();
  }
  ++next_;
  if (finished || next_ % clock_period_frames == 0) {
    erp::Clock clock;
    clock.stamp_ns = played_ns_;
    clock.finished = finished;
    clock_out_.publish(clock);
  }
  if (finished) node_.finish();
}

}  // namespace replay
