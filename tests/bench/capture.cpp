// Measures the duration of motion capture for a pair of images, and the error of its joint angles.
// The arm moves as in figure 8 of the paper, with 100 pairs per second. Noise and bone lengths are
// those of configs/arm/motion_capture.xml.
#include <cstdio>
#include <numbers>

#include "interfaces/recording/table.hpp"
#include "sim/control/pose_plan.hpp"
#include "tests/bench/times.hpp"
#include "tests/components/motion_capture/studio.hpp"

namespace {

constexpr double period_s = 0.01, degree = std::numbers::pi / 180;

sim::JointPath motion_of_figure_8(const erp::Robot& robot) {
  return {robot.joints(),
          sim::poses_of(recording::read_table(ERP_SOURCE_DIR "/configs/arm/figure_8.csv"), robot)};
}

/// Sum of squared errors of each joint, and number of pairs in which its angle was known.
struct Errors {
  std::vector<double> square_rad2;
  std::vector<int> known_count;

  explicit Errors(std::size_t joints) : square_rad2(joints), known_count(joints) {}
  void add(const capture::Captured& captured, std::span<const sim::JointReading> truth) {
    for (std::size_t j = 0; j < truth.size(); ++j) {
      if (!captured.known[j]) continue;
      const auto error_rad =
          sim::displacement(truth[j].type, truth[j].position, captured.joints[j].position);
      square_rad2[j] +=
          error_rad[0] * error_rad[0] + error_rad[1] * error_rad[1] + error_rad[2] * error_rad[2];
      ++known_count[j];
    }
  }
};

void print(const char* label, bench::Durations& durations) {
  std::printf("%-24s p50 %7.2f ms, p99 %7.2f ms: %4.0f per second\n", label,
              1e-3 * durations.quantile_us(0.5), 1e-3 * durations.quantile_us(0.99),
              1e6 / durations.mean_us());
}

}  // namespace

int main() {
  tests::Studio studio;
  const auto path = motion_of_figure_8(studio.robot);
  const auto joints = studio.robot.joints();
  capture::Capture motion_capture = studio.capture();
  bench::Durations rendering_durations, capture_durations;
  Errors errors(joints.size());
  std::vector<sim::JointMotion> motions;
  int pairs = 0;
  for (double t_s = path.begin_s(); t_s <= path.end_s(); t_s += period_s, ++pairs) {
    path.at(t_s, motions);
    std::vector<sim::JointReading> truth;
    for (const auto& motion : motions) truth.push_back(motion.now);
    std::array<sim::cameras::Image, 2> pair;
    std::optional<capture::Captured> captured;
    rendering_durations.measure([&] { pair = studio.images(truth); });
    capture_durations.measure(
        [&] { captured = motion_capture.process(pair[0], pair[1], period_s); });
    if (captured) errors.add(*captured, truth);
  }
  print("render a pair", rendering_durations);
  print("pair to joint angles", capture_durations);
  for (std::size_t j = 0; j < joints.size(); ++j)
    if (errors.known_count[j] > 0)
      std::printf("%-24s %.3f° RMS, known in %d of %d pairs\n", joints[j].name.c_str(),
                  std::sqrt(errors.square_rad2[j] / errors.known_count[j]) / degree,
                  errors.known_count[j], pairs);
}
