#pragma once
#include "components/motion_capture/motion_capture.hpp"
#include "interfaces/xml/xml.hpp"

namespace tests {

using namespace capture;
using sim::Vec3;

/// The arm in front of its two cameras, with the parameters of its config.
struct Studio {
  erp::Robot robot = erp::read_robot(ERP_SOURCE_DIR "/configs/arm/robot.xml");
  MotionCapture::Params params;
  sim::RobotTree tree{robot};
  std::vector<Marker> markers;
  std::array<sim::cameras::Camera, 2> cameras;
  std::vector<sim::cameras::Painter> painters;
  sim::SkeletonModel bones{tree, Vec3::Zero()};

  Studio()
      : params(read()),
        markers(markers_of(params.view.markers, tree)),
        cameras{sim::cameras::Camera(params.view.cameras[0]),
                sim::cameras::Camera(params.view.cameras[1])} {
    for (std::uint64_t c = 0; c < 2; ++c)
      painters.emplace_back(cameras[c], sim::cameras::Light{}, c + 1);
  }
  static MotionCapture::Params read() {
    MotionCapture::Params params;
    xml::read_into(params, ERP_SOURCE_DIR "/configs/arm/motion_capture.xml", "motion_capture");
    return params;
  }
  Capture capture() const { return {tree, markers, cameras, params.options}; }

  std::vector<sim::cameras::Ball> balls() const {
    std::vector<sim::cameras::Ball> result;
    for (const Marker& m : markers) {
      const sim::BodyPose& body = bones.poses()[m.body];
      result.push_back({body.position_m + body.rotation * m.at_m, params.image_params.ball_m});
    }
    return result;
  }
  std::vector<sim::cameras::Bone> limbs() const {
    std::vector<sim::cameras::Bone> result;
    for (const auto& bone : params.image_params.bones) {
      const auto body = std::size_t(std::ranges::find(tree.names, bone.body) - tree.names.begin());
      const sim::BodyPose& pose = bones.poses()[body];
      const auto position = [&](const xml::Vec3& v) {
        return Vec3(pose.position_m + pose.rotation * Vec3(v[0], v[1], v[2]));
      };
      result.push_back({position(bone.from_m), position(bone.to_m), bone.radius_m});
    }
    return result;
  }
  std::array<sim::cameras::Image, 2> images(std::span<const sim::JointReading> joints,
                                            std::span<const sim::cameras::Bone> additional = {}) {
    bones.place(joints);
    auto occluders = limbs();
    occluders.insert(occluders.end(), additional.begin(), additional.end());
    return {painters[0].paint(balls(), occluders), painters[1].paint(balls(), occluders)};
  }
};

}  // namespace tests
