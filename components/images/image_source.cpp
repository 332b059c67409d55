#include "components/images/image_source.hpp"

#include <cmath>
#include <filesystem>

#include "components/images/image_files.hpp"
#include "sim/model/skeleton/robot_tree.hpp"

namespace images {

using sim::vec;

constexpr double tick_s = 0.002;  // period of the sensor frames, whose numbers the images use

ImageSource::ImageSource(const ImageSourceParams& params, const sim::cameras::ViewConfig& view,
                         const std::string& config_file, const erp::Robot& robot, node::Node& node,
                         OnFrame on_frame)
    : params_(params),
      cameras_(view.cameras),
      node_(node),
      on_frame_(std::move(on_frame)),
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
  for (std::string* folder : {&params_.images, &params_.save})
    if (!folder->empty())
      *folder = (std::filesystem::path(config_file).parent_path() / *folder).string();
  if (!params_.save.empty()) std::filesystem::create_directories(params_.save);
  for (std::size_t c = 0; c < cameras_.size(); ++c)
    painters_.emplace_back(sim::cameras::Camera(cameras_[c]),
                           sim::cameras::Light{.noise = params_.noise},
                           static_cast<std::uint64_t>(params_.seed) + c);
  if (params_.images.empty())
    node.subscribe<erp::JointState>(  // in_loop: the node may also publish joint_state
        [this](const erp::JointState& state) {
          if (std::string_view(state.source) == "sim") render(state);
        },
        8, node::Where::in_loop);
  else node.every(std::llround(1e9 * params_.period_s), [this] { read_files(); });
}

void ImageSource::render(const erp::JointState& truth) {
  const auto period_ns = std::llround(1e9 * params_.period_s);
  const auto tolerance_ns = period_ns / 100;            // rounding of the stamps; chosen
  const auto since_ns = truth.stamp_ns - rendered_ns_;  // negative: the clock was set back
  const bool is_due = since_ns < 0 || since_ns >= period_ns - tolerance_ns;
  if (!is_due || !names_.read(truth, truth_)) return;
  rendered_ns_ = truth.stamp_ns;
  node_.clock().advance(truth.stamp_ns);
  model_.place(truth_);
  const auto world_position_m = [&](const OnBody& part, const sim::Vec3& at_m) -> sim::Vec3 {
    const sim::BodyPose& pose = model_.poses()[part.body];
    return pose.position_m + pose.rotation * at_m;
  };
  std::vector<sim::cameras::Ball> balls;
  for (const OnBody& ball : balls_)
    balls.push_back({world_position_m(ball, ball.from_m), ball.radius_m});
  std::vector<sim::cameras::Bone> bones;
  for (const OnBody& bone : bones_)
    bones.push_back(
        {world_position_m(bone, bone.from_m), world_position_m(bone, bone.to_m), bone.radius_m});
  for (std::size_t c = 0; c < painters_.size(); ++c) frame_[c] = painters_[c].paint(balls, bones);
  if (!params_.save.empty()) save_frame();
  pass_frame(truth.sequence, truth.stamp_ns);
}

void ImageSource::save_frame() {
  for (std::size_t c = 0; c < frame_.size(); ++c)
    write_image(image_name(params_.save, cameras_[c].name, frame_count_), frame_[c]);
}

void ImageSource::read_files() {
  for (std::size_t c = 0; c < frame_.size(); ++c) {
    const auto& camera = cameras_[c];
    auto image = read_image(image_name(params_.images, camera.name, frame_count_), camera.width_px,
                            camera.height_px);
    if (!image) {
      node_.report(
          erp::Severity::info, "images", "end",
          std::to_string(frame_count_) + " images of each camera read from " + params_.images);
      return node_.finish();
    }
    frame_[c] = std::move(*image);
  }
  const double ticks = static_cast<double>(frame_count_) * params_.period_s / tick_s;
  pass_frame(static_cast<std::uint64_t>(std::llround(ticks)), node_.clock().stamp_ns());
}

void ImageSource::pass_frame(std::uint64_t sequence, std::int64_t stamp_ns) {
  ++frame_count_;
  on_frame_(frame_, sequence, stamp_ns);
  node_.count_step(stamp_ns);
}

}  // namespace images
