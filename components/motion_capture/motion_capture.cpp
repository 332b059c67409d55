#include "components/motion_capture/motion_capture.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <stdexcept>

namespace capture {
namespace {

/// Chosen: longest interval of images, in periods, over which a motion is predicted.
constexpr double max_interval_periods = 10;

std::array<sim::cameras::Camera, 2> cameras_of(const MotionCapture::Params& params) {
  if (params.view.cameras.size() != 2)
    throw std::invalid_argument(
        "motion capture needs two <camera> elements, left and right; found " +
        std::to_string(params.view.cameras.size()));
  return {sim::cameras::Camera(params.view.cameras[0]),
          sim::cameras::Camera(params.view.cameras[1])};
}

}  // namespace

MotionCapture::MotionCapture(const Params& params, const erp::Robot& robot, node::Node& node)
    : params_(params),
      node_(node),
      names_(robot),
      capture_(sim::RobotTree(robot), markers_of(params.view.markers, sim::RobotTree(robot)),
               cameras_of(params), params.options),
      joints_out_(node.advertise<erp::JointState>()),
      bodies_out_(node.advertise<erp::BodyPose>()),
      interval_(max_interval_periods * params.image_params.period_s),
      image_source_(params.image_params, params.view, params.place.file, robot, node,
                    [this](const auto& pair, std::uint64_t sequence, std::int64_t stamp_ns) {
                      on_images(pair, sequence, stamp_ns);
                    }) {}

void MotionCapture::on_images(const images::ImageSource::Frame& pair, std::uint64_t sequence,
                              std::int64_t stamp_ns) {
  const double dt_s = is_first_ ? params_.image_params.period_s
                                : interval_.add_s(stamp_ns, node_.clock().elapsed_ns());
  is_first_ = false;
  const auto captured = capture_.process(pair[0], pair[1], dt_s);
  report_change();
  if (captured) publish(*captured, sequence, stamp_ns);
}

void MotionCapture::report_change() {
  if (capture_.lost() == was_lost_) return;
  was_lost_ = capture_.lost();
  node_.report(
      was_lost_ ? erp::Severity::warning : erp::Severity::info, "markers",
      was_lost_ ? "lost" : "found",
      was_lost_ ? "too few of the robot's markers are visible; nothing is published until they are"
                : "the robot's markers are tracked");
}

void MotionCapture::publish(const Captured& captured, std::uint64_t sequence,
                            std::int64_t stamp_ns) {
  erp::JointState state;
  erp::assign(state.source, "motion_capture");
  state.stamp_ns = stamp_ns, state.sequence = sequence;
  names_.write(captured.joints, captured.variance_rad2, capture_.fit().model(), state,
               captured.known);
  joints_out_.publish_numbered(state);
  erp::BodyPose bodies;
  erp::assign(bodies.source, "motion_capture");
  bodies.stamp_ns = stamp_ns;
  for (std::size_t b = 0; b < captured.bodies.size(); ++b) {
    if (!captured.bodies[b]) continue;
    const Eigen::Quaterniond q(captured.bodies[b]->rotation);
    erp::BodyPoseSample sample{};
    erp::assign(sample.name, capture_.fit().tree().names[b]);
    std::ranges::copy(captured.bodies[b]->position_m, sample.position_m);
    std::ranges::copy(std::array{q.w(), q.x(), q.y(), q.z()}, sample.orientation_wxyz);
    erp::append(bodies.bodies, sample);
  }
  bodies_out_.publish(bodies);
}

}  // namespace capture
