#include "components/motion_capture/capture.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <numbers>

#include "components/images/image_files.hpp"
#include "interfaces/recording/table.hpp"
#include "sim/control/pose_plan.hpp"
#include "tests/components/motion_capture/studio.hpp"
#include "tests/interfaces/recording/support.hpp"

using namespace capture;
using images::image_name, images::read_image, images::write_image;
using sim::Vec3;
using tests::Studio;

namespace {

constexpr double period_s = 0.01, degree = std::numbers::pi / 180;

double angle_between_rad(const sim::JointReading& a, const sim::JointReading& b) {
  const auto rotation = sim::displacement(a.type, a.position, b.position);
  return std::hypot(rotation[0], rotation[1], rotation[2]);
}

/// Result of tracking the arm through its figure: RMS error by joint over the images in which the
/// arm was found.
struct Tracked {
  std::vector<double> rms_rad;
  int images = 0, found = 0;
};
Tracked track_figure(Studio& studio, std::span<const sim::cameras::Bone> poles = {}) {
  const auto poses = sim::poses_of(
      recording::read_table(ERP_SOURCE_DIR "/configs/arm/figure_8.csv"), studio.robot);
  const sim::JointPath path(studio.robot.joints(), poses);
  Capture capture = studio.capture();
  Tracked tracked{std::vector<double>(studio.robot.joints().size()), 0, 0};
  std::vector<sim::JointMotion> motions;
  std::vector<sim::JointReading> joints;
  for (double t = 0; t < 8; t += period_s) {
    path.at(t, motions);
    joints.clear();
    for (const auto& motion : motions) joints.push_back(motion.now);
    const auto pair = studio.images(joints, poles);
    const auto captured = capture.process(pair[0], pair[1], period_s);
    ++tracked.images;
    if (!captured) continue;
    ++tracked.found;
    for (std::size_t j = 0; j < joints.size(); ++j)
      tracked.rms_rad[j] += std::pow(angle_between_rad(captured->joints[j], joints[j]), 2);
  }
  for (double& e : tracked.rms_rad) e = std::sqrt(e / tracked.found);
  return tracked;
}

}  // namespace

TEST_CASE("a pixel's ray passes through the projected point, with and without distortion") {
  for (const double k1 : {0.0, -0.2, 0.1}) {
    const sim::cameras::Camera camera(
        {{}, "c", {1.7, 0.3, 0.2}, {0, -0.2, -0.1}, {0, 0, 1}, 800, 640, 480, 5, -3, k1, 0.02});
    for (const Vec3& p : {Vec3(0.1, 0, 0), Vec3(-0.2, -0.5, 0.3), Vec3(0.4, 0.2, -0.4)}) {
      const auto pixel = camera.project(p);
      REQUIRE(pixel);
      CHECK((camera.at_m() + camera.ray(*pixel) * (p - camera.at_m()).norm() - p).norm() < 1e-9);
    }
    CHECK_FALSE(camera.project({3, 0, 0}));  // behind it
  }
}

TEST_CASE("the spot of a ball is within 0.1 pixel of its projection") {
  Studio studio;
  const sim::cameras::Ball ball{{0.1, -0.1, -0.2}, 0.007};
  for (const auto& camera : studio.cameras) {
    sim::cameras::Painter painter(camera, {}, 3);
    const auto spots = find_spots(painter.paint(std::span(&ball, 1), {}), {});
    REQUIRE(spots.size() == 1);
    CHECK((spots[0].centre - *camera.project(ball.at_m)).norm() < 0.1);
  }
}

TEST_CASE("two balls seen by two cameras give two points within 1 mm") {
  Studio studio;
  const std::vector<sim::cameras::Ball> balls{{{0.1, -0.1, -0.2}, 0.007}, {{0, -0.3, 0.1}, 0.007}};
  std::array<std::vector<Spot>, 2> spots;
  for (std::size_t c = 0; c < 2; ++c)
    spots[c] = find_spots(studio.painters[c].paint(balls, {}), {});
  const auto points =
      triangulate(studio.cameras[0], spots[0], studio.cameras[1], spots[1], StereoOptions{});
  REQUIRE(points.size() == 2);
  for (const auto& ball : balls)
    CHECK(std::ranges::any_of(points,
                              [&](const auto& p) { return (p.at_m - ball.at_m).norm() < 0.001; }));
}

TEST_CASE("the arm is tracked through its figure within 0.3 degrees although bones hide markers") {
  Studio studio;
  const auto tracked = track_figure(studio);
  CHECK(tracked.found == tracked.images);
  for (const double e : tracked.rms_rad) CHECK(e < 0.3 * degree);
}

TEST_CASE("an arm behind a pole is tracked within 0.3 degrees") {
  Studio studio;
  const sim::cameras::Bone pole{{0.8, -0.25, -1}, {0.8, -0.25, 1}, 0.02};
  const auto tracked = track_figure(studio, std::span(&pole, 1));
  CHECK(tracked.found > 0.9 * tracked.images);
  for (const double e : tracked.rms_rad) CHECK(e < 0.3 * degree);
}

TEST_CASE("a robot is found after it was hidden, and away from its predicted pose") {
  Studio studio;
  Capture capture = studio.capture();
  std::vector<sim::JointReading> joints;
  for (const auto& joint : studio.robot.joints()) joints.push_back(sim::initial_reading(joint));
  joints[1].position[0] = 1.4;
  joints[0].position =
      sim::displaced(joints[0].type, joints[0].position, std::array<double, 3>{0.3, -0.5, 0.4});
  const auto pair = studio.images(joints);
  const auto captured = capture.process(pair[0], pair[1], period_s);
  REQUIRE(captured);
  for (std::size_t j = 0; j < joints.size(); ++j)
    CHECK(angle_between_rad(captured->joints[j], joints[j]) < 0.5 * degree);
  const sim::cameras::Bone wall{{0.5, -2, -0.2}, {0.5, 2, -0.2}, 1};
  const auto hidden = studio.images(joints, std::span(&wall, 1));
  CHECK_FALSE(capture.process(hidden[0], hidden[1], period_s));
  CHECK(capture.lost());
  CHECK(capture.process(pair[0], pair[1], period_s));
}

TEST_CASE("a joint whose body is hidden is unknown, and is found again at another angle") {
  Studio studio;
  Capture capture = studio.capture();
  std::vector<sim::JointReading> joints;
  for (const auto& joint : studio.robot.joints()) joints.push_back(sim::initial_reading(joint));
  auto pair = studio.images(joints);
  REQUIRE(capture.process(pair[0], pair[1], period_s));
  const sim::cameras::Bone wall{{0.6, -2, -0.67}, {0.6, 2, -0.67}, 0.55};
  pair = studio.images(joints, std::span(&wall, 1));
  auto captured = capture.process(pair[0], pair[1], period_s);
  REQUIRE(captured);
  CHECK(captured->known == std::vector{true, false});
  joints[1].position[0] = 1.5;
  pair = studio.images(joints);
  captured = capture.process(pair[0], pair[1], period_s);
  REQUIRE(captured);
  CHECK(captured->known == std::vector{true, true});
  CHECK(angle_between_rad(captured->joints[1], joints[1]) < 0.5 * degree);
}

TEST_CASE("an image is unchanged after writing and reading, and a wrong size is refused") {
  test::Folder folder;
  Studio studio;
  const auto pair = studio.images(std::vector{sim::initial_reading(studio.robot.joints()[0]),
                                              sim::initial_reading(studio.robot.joints()[1])});
  const auto file = image_name(folder / "", "left", 3);
  write_image(file, pair[0]);
  CHECK(read_image(file, 640, 480)->pixels == pair[0].pixels);
  CHECK_THROWS_WITH(read_image(file, 320, 240), Catch::Contains("640 × 480"));
  CHECK_FALSE(read_image(image_name(folder / "", "left", 4), 640, 480));
  CHECK_THROWS_AS(write_image((folder / "no/such") + "/a.png", pair[0]), std::invalid_argument);
}

TEST_CASE("a marker on an unknown body and a camera along its up axis are refused") {
  Studio studio;
  const MarkerConfig tail{{}, "tail", {}};
  CHECK_THROWS_WITH(markers_of(std::span(&tail, 1), studio.tree), Catch::Contains("tail"));
  CHECK_THROWS_WITH(sim::cameras::Camera({{}, "c", {0, 0, 1}, {0, 0, 0}}),
                    Catch::Contains("parallel to up"));
}
