#include "components/images/image_source.hpp"

#include <cmath>
#include <filesystem>

#include "components/images/image_files.hpp"
#include "sim/model/skeleton/robot_tree.hpp"

namespace images {

using sim::vec;

ImageSource::ImageSource(const ImageSourceParams& params, const sim::cameras::ViewConfig& view,
                         const std::string& config_file, const erp::Robot& robot, node::Node& node,
                         Use use)
    : params_(params),
      cameras_(view.cameras),
      node_(node),
      use_(std::move(use)),
      names_(robot),
      model_(sim::RobotTree(robot), sim::Vec3::Zero()),
      frame_(view.cameras.size()) {
  const sim::RobotTree tree(robot);
  for (const auto& marker : view.markers)
    balls_.push_back({sim::body_named(tree.names, marker.body, "a marker"), vec(marker.at_m),
                      vec(marker.at_m), params_.ball_m});
  for (const BoneConfig& bone : params_.bones)
    bones_.push_back({sim::body_named(tree.names, bone.body, "a bone"), vec(bone.from_m),
                      vec(bone.to_m), bone.radius_m});
  for (std::string* one : {&params_.images, &params_.save})
    if (!one->empty()) *one = (std::filesystem::path(config_file).parent_path() / *one).string();
  if (!params_.save.empty()) std::filesystem::create_directories(params_.save);
  for (std::size_t c = 0; c < cameras_.size(); ++c)
    painters_.emplace_back(sim::cameras::Camera(cameras_[c]),
                           sim::cameras::Light{.noise = params_.noise},
                           static_cast<std::uint64_t>(params_.seed) + c);
  if (params_.images.empty())
    node.subscribe<erp::JointState>(  // in the loop: a node that films may publish joint_state too
        [this](const erp::JointState& state) {
          if (std::string_view(state.source) == "sim") paint(state);
        },
        8, node::Where::in_loop);
  else node.every(std::llround(1e9 * params_.period_s), [this] { read_files(); });
}

void ImageSource::paint(const erp::JointState& truth) {
  const auto period_ns = std::llround(1e9 * params_.period_s);
  if (truth.stamp_ns - painted_ns_ < period_ns - period_ns / 100 || !names_.read(truth, truth_))
    return;
  painted_ns_ = truth.stamp_ns;
  model_.place(truth_);
  const auto there = [&](const OnBody& on, const sim::Vec3& at_m) -> sim::Vec3 {
    const sim::BodyPose& pose = model_.poses()[on.body];
    return pose.position_m + pose.rotation * at_m;
  };
  std::vector<sim::cameras::Ball> balls;
  for (const OnBody& ball : balls_) balls.push_back({there(ball, ball.from_m), ball.radius_m});
  std::vector<sim::cameras::Bone> bones;
  for (const OnBody& bone : bones_)
    bones.push_back({there(bone, bone.from_m), there(bone, bone.to_m), bone.radius_m});
  for (std::size_t c = 0; c < painters_.size(); ++c) frame_[c] = painters_[c].paint(balls, bones);
  if (!params_.save.empty()) save_frame();
  show(truth.sequence, truth.stamp_ns);
}

void ImageSource::save_frame() {
  for (std::size_t c = 0; c < frame_.size(); ++c)
    write_image(image_name(params_.save, cameras_[c].name, frames_), frame_[c]);
}

void ImageSource::read_files() {
  for (std::size_t c = 0; c < frame_.size(); ++c) {
    const auto& camera = cameras_[c];
    auto image = read_image(image_name(params_.images, camera.name, frames_), camera.width_px,
                            camera.height_px);
    if (!image) {
      node_.report(erp::Severity::info, "images", "end",
                   std::to_string(frames_) + " images of each camera read from " + params_.images);
      return node_.finish();
    }
    frame_[c] = std::move(*image);
  }
  const double ticks = static_cast<double>(frames_) * params_.period_s / 0.002;
  show(static_cast<std::uint64_t>(std::llround(ticks)), node_.clock().now_ns());
}

void ImageSource::show(std::uint64_t sequence, std::int64_t stamp_ns) {
  ++frames_;
  use_(frame_, sequence, stamp_ns);
  node_.count_step(stamp_ns);
}

}  // namespace images
