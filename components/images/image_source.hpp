#pragma once
#include <functional>
#include <string>
#include <vector>

#include "components/joints/joints.hpp"
#include "components/node/node.hpp"
#include "interfaces/xml/fields.hpp"
#include "sim/model/cameras/images.hpp"
#include "sim/model/cameras/view.hpp"

/// A sequence of camera images: rendered from the sim's joint_state, or read from a folder
/// (<camera>_00000.png, …, one per camera and period).
namespace images {

/// `<bone body="forearm" from_m="…" to_m="…" radius_m="…"/>`: a bone that hides the markers behind
/// it.
struct BoneConfig {
  static constexpr auto element = "bone";
  static constexpr auto description = "Bone that hides the markers behind it in rendered images.";
  xml::Place place;
  std::string body;
  xml::Vec3 from_m{0, 0, 0}, to_m{0, 0, 0};
  double radius_m = 0.03;
  void visit(auto& v) {
    v.required("body", body, "Body that contains the bone.");
    v.required("from_m", from_m, "First end of the bone in the frame of the body.");
    v.required("to_m", to_m, "Second end of the bone in the frame of the body.");
    v("radius_m", radius_m, {xml::positive, "Radius of the bone, a capsule; chosen."});
  }
};

struct ImageSourceParams {
  std::string images;
  std::string save;
  double period_s = 0.01;
  int seed = 1;
  double ball_m = 0.007;
  double noise = 4;
  std::vector<BoneConfig> bones;
  void visit(auto& v) {
    v("images", images,
      "Folder of image files, <camera>_00000.png and so on, relative to the config; empty: images "
      "are rendered.");
    v("save", save, "Folder to which rendered images are written; empty: none.");
    v("period_s", period_s, {xml::positive, "Time between two images."});
    v("seed", seed, {xml::Range{0, 1e9}, "Seed of the pixel noise."});
    v("ball_m", ball_m, {xml::positive, "Radius of a marker."});
    v("noise", noise,
      {xml::at_least_zero, "Standard deviation of the brightness of a rendered pixel, of 255."});
    v.list(bones);
  }
};

class ImageSource {
 public:
  /// One image per camera, in the order of the cameras, of one instant.
  using Frame = std::vector<sim::cameras::Image>;
  using OnFrame = std::function<void(const Frame&, std::uint64_t sequence, std::int64_t stamp_ns)>;

  /// `config_file`: the config that names the folders. Throws std::invalid_argument if the body of
  /// a marker or bone does not exist.
  ImageSource(const ImageSourceParams& params, const sim::cameras::ViewConfig& view,
              const std::string& config_file, const erp::Robot& robot, node::Node& node,
              OnFrame on_frame);

 private:
  struct OnBody {
    std::size_t body;
    sim::Vec3 from_m, to_m;
    double radius_m;
  };
  void render(const erp::JointState& truth);
  void read_files();
  void save_frame();
  void pass_frame(std::uint64_t sequence, std::int64_t stamp_ns);

  ImageSourceParams params_;
  std::vector<sim::cameras::CameraConfig> cameras_;
  node::Node& node_;
  OnFrame on_frame_;
  joints::Names names_;
  sim::SkeletonModel model_;
  std::vector<OnBody> balls_, bones_;
  std::vector<sim::cameras::Painter> painters_;
  std::vector<sim::JointReading> truth_;
  Frame frame_;
  std::int64_t rendered_ns_ = 0;
  std::uint64_t frame_count_ = 0;
};

}  // namespace images
