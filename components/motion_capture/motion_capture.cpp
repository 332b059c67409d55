#include "components/motion_capture/motion_capture.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <stdexcept>

#include "components/motion_capture/image_files.hpp"

namespace capture {
namespace {

using sim::vec, sim::Vec3;

std::array<sim::cameras::Camera, 2> cameras_of(const MotionCapture::Params& params) {
  if (params.cameras.size() != 2)
    throw std::invalid_argument("motion capture needs two <camera>, left and right; there are " +
                                std::to_string(params.cameras.size()));
  return {sim::cameras::Camera(params.cameras[0]), sim::cameras::Camera(params.cameras[1])};
}

}  // namespace

MotionCapture::MotionCapture(const Params& params, const erp::Robot& robot, node::Node& node)
    : params_(params),
      node_(node),
      names_(robot),
      capture_(sim::RobotTree(robot), markers_of(params.markers, sim::RobotTree(robot)),
               cameras_of(params), params.options),
      joints_out_(node.advertise<erp::JointState>()),
      bodies_out_(node.advertise<erp::BodyPose>()) {
  const auto& names = capture_.fit().tree().names;
  for (const BoneConfig& bone : params_.bones)
    bones_.push_back({sim::body_named(names, bone.body, "a bone"),
                      {vec(bone.from_m), vec(bone.to_m), bone.radius_m}});
  const auto folder = std::filesystem::path(params_.place.file).parent_path();
  for (std::string* one : {&params_.images, &params_.save})
    if (!one->empty()) *one = (folder / *one).string();
  if (!params_.save.empty()) std::filesystem::create_directories(params_.save);
  for (std::size_t c = 0; c < 2; ++c)
    painters_.emplace_back(cameras_of(params)[c], sim::cameras::Light{.noise = params.noise},
                           static_cast<std::uint64_t>(params.seed) + c);
  if (params_.images.empty())
    node.subscribe<erp::JointState>(  // in the loop: what it says itself arrives here as well
        [this](const erp::JointState& state) {
          if (std::string_view(state.source) == "sim") paint(state);
        },
        8, node::Where::in_loop);
  else node.every(std::llround(1e9 * params_.period_s), [this] { read_files(); });
}

void MotionCapture::paint(const erp::JointState& truth) {
  const auto period_ns = std::llround(1e9 * params_.period_s);
  if (truth.stamp_ns - painted_ns_ < period_ns - period_ns / 100 || !names_.read(truth, truth_))
    return;
  painted_ns_ = truth.stamp_ns;
  const auto poses = capture_.fit().poses(truth_);
  std::vector<sim::cameras::Ball> balls;
  for (const Marker& marker : capture_.fit().markers())
    balls.push_back({poses[marker.body].position_m + poses[marker.body].rotation * marker.at_m,
                     params_.ball_m});
  std::vector<sim::cameras::Bone> bones;
  for (const Bone& one : bones_) {
    const sim::BodyPose& pose = poses[one.body];
    bones.push_back({pose.position_m + pose.rotation * one.bone.from_m,
                     pose.position_m + pose.rotation * one.bone.to_m, one.bone.radius_m});
  }
  for (std::size_t c = 0; c < 2; ++c) pair_[c] = painters_[c].paint(balls, bones);
  if (!params_.save.empty()) keep(pair_);
  see(pair_, truth.sequence, truth.stamp_ns);
}

void MotionCapture::keep(const Pair& pair) {
  for (std::size_t c = 0; c < 2; ++c)
    write_image(image_name(params_.save, params_.cameras[c].name, images_), pair[c]);
}

void MotionCapture::read_files() {
  for (std::size_t c = 0; c < 2; ++c) {
    const auto& camera = params_.cameras[c];
    auto image = read_image(image_name(params_.images, camera.name, images_), camera.width_px,
                            camera.height_px);
    if (!image) {
      node_.report(erp::Severity::info, "images", "end",
                   std::to_string(images_) + " pairs of " + params_.images + " seen");
      return node_.finish();
    }
    pair_[c] = std::move(*image);
  }
  const double ticks = static_cast<double>(images_) * params_.period_s / 0.002;
  see(pair_, static_cast<std::uint64_t>(std::llround(ticks)), node_.clock().now_ns());
}

void MotionCapture::see(const Pair& pair, std::uint64_t sequence, std::int64_t stamp_ns) {
  ++images_;
  const double dt_s =
      seen_ns_ ? 1e-9 * static_cast<double>(stamp_ns - *seen_ns_) : params_.period_s;
  seen_ns_ = stamp_ns;
  const auto found = capture_.see(pair[0], pair[1], dt_s);
  tell_change();
  if (found) publish(*found, sequence, stamp_ns);
  node_.count_step(stamp_ns);
}

void MotionCapture::tell_change() {
  if (capture_.lost() == was_lost_) return;
  was_lost_ = capture_.lost();
  node_.report(was_lost_ ? erp::Severity::warning : erp::Severity::info, "markers",
               was_lost_ ? "lost" : "found",
               was_lost_ ? "the robot's markers are not seen well enough: it says nothing"
                         : "the robot's markers are followed");
}

void MotionCapture::publish(const Captured& found, std::uint64_t sequence, std::int64_t stamp_ns) {
  erp::JointState state;
  erp::assign(state.source, "motion_capture");
  state.stamp_ns = stamp_ns, state.sequence = sequence;
  names_.write(found.joints, found.variance_rad2, capture_.fit().model(), state, found.known);
  joints_out_.publish_numbered(state);
  erp::BodyPose bodies;
  erp::assign(bodies.source, "motion_capture");
  bodies.stamp_ns = stamp_ns;
  for (std::size_t b = 0; b < found.bodies.size(); ++b) {
    if (!found.bodies[b]) continue;
    const Eigen::Quaterniond q(found.bodies[b]->rotation);
    erp::BodyPoseSample sample{};
    erp::assign(sample.name, capture_.fit().tree().names[b]);
    std::ranges::copy(found.bodies[b]->position_m, sample.position_m);
    std::ranges::copy(std::array{q.w(), q.x(), q.y(), q.z()}, sample.orientation_wxyz);
    erp::append(bodies.bodies, sample);
  }
  bodies_out_.publish(bodies);
}

}  // namespace capture
