// Duration of motion capture for a pair of images, and error of its joint angles: the arm moves
// through its figure at 100 pairs per second, with noise and bone lengths of
// configs/arm/motion_capture.xml.
#include <cstdio>
#include <numbers>

#include "interfaces/recording/table.hpp"
#include "sim/control/pose_plan.hpp"
#include "tests/bench/times.hpp"
#include "tests/components/motion_capture/studio.hpp"

namespace {

constexpr double period_s = 0.01, degree = std::numbers::pi / 180;

sim::JointPath figure(const erp::Robot& robot) {
  return {robot.joints(),
          sim::poses_of(recording::read_table(ERP_SOURCE_DIR "/configs/arm/figure_8.csv"), robot)};
}

/// Sum of squared errors of each joint, and number of images in which its angle was known.
struct Errors {
  std::vector<double> square_rad2;
  std::vector<int> known;

  explicit Errors(std::size_t joints) : square_rad2(joints), known(joints) {}
  void take(const capture::Captured& found, std::span<const sim::JointReading> truth) {
    for (std::size_t j = 0; j < truth.size(); ++j) {
      if (!found.known[j]) continue;
      const auto way = sim::way_between(truth[j].type, truth[j].position, found.joints[j].position);
      square_rad2[j] += way[0] * way[0] + way[1] * way[1] + way[2] * way[2];
      ++known[j];
    }
  }
};

void print(const char* what, bench::Times& times) {
  std::printf("%-24s p50 %7.2f ms, p99 %7.2f ms: %4.0f per second\n", what, 1e-3 * times.at(0.5),
              1e-3 * times.at(0.99), 1e6 / times.mean());
}

}  // namespace

int main() {
  tests::Studio studio;
  const auto path = figure(studio.robot);
  const auto joints = studio.robot.joints();
  capture::Capture capturing = studio.capture();
  bench::Times rendering, capturing_times;
  Errors errors(joints.size());
  std::vector<sim::JointMotion> motions;
  int pairs = 0;
  for (double t_s = path.begin_s(); t_s <= path.end_s(); t_s += period_s, ++pairs) {
    path.at(t_s, motions);
    std::vector<sim::JointReading> truth;
    for (const auto& motion : motions) truth.push_back(motion.now);
    std::array<sim::cameras::Image, 2> pair;
    std::optional<capture::Captured> found;
    rendering.take([&] { pair = studio.images(truth); });
    capturing_times.take([&] { found = capturing.process(pair[0], pair[1], period_s); });
    if (found) errors.take(*found, truth);
  }
  print("render a pair", rendering);
  print("pair to joint angles", capturing_times);
  for (std::size_t j = 0; j < joints.size(); ++j)
    if (errors.known[j] > 0)
      std::printf("%-24s %.3f° RMS, known in %d of %d pairs\n", joints[j].name.c_str(),
                  std::sqrt(errors.square_rad2[j] / errors.known[j]) / degree, errors.known[j],
                  pairs);
}
