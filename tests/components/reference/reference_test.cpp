#include "components/reference/reference.hpp"

#include <unistd.h>
#include <catch2/catch.hpp>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "interfaces/recording/error.hpp"

using reference::Shape;
using reference::Signal;

namespace {

Signal signal(Shape shape) {
  Signal s;
  s.actuator = "flexor", s.shape = shape, s.offset = 2, s.amplitude = 38, s.start_s = 1;
  return s;
}

struct TemporaryFile {
  std::string path =
      (std::filesystem::temp_directory_path() / ("erp_" + std::to_string(getpid()) + ".csv"))
          .string();
  explicit TemporaryFile(const std::string& text) { std::ofstream(path) << text; }
  ~TemporaryFile() { std::remove(path.c_str()); }
};

erp::Robot one_muscle() {
  erp::Robot robot;
  robot.name = "one";
  robot.actuators.emplace_back().name = "flexor";
  return robot;
}

}  // namespace

TEST_CASE("a step is its offset before the start and offset plus amplitude after it") {
  const auto step = signal(Shape::step);
  CHECK(step.at(0.999) == 2);
  CHECK(step.at(1.0) == 40);
  CHECK(step.at(1e6) == 40);
}

TEST_CASE("a sine starts at its offset and oscillates by its amplitude") {
  auto sine = signal(Shape::sine);
  sine.frequency_Hz = 0.5;
  CHECK(sine.at(1.0) == Approx(2));
  CHECK(sine.at(1.5) == Approx(40));
  CHECK(sine.at(2.5) == Approx(-36));
}

TEST_CASE("the phase of a sweep is half of f0 + f1 times its duration") {
  auto sweep = signal(Shape::sweep);
  sweep.frequency_Hz = 1, sweep.end_frequency_Hz = 3, sweep.duration_s = 2;
  // 4 complete periods in 2 s: at the end the sweep is at its offset again.
  CHECK(sweep.at(3.0 - 1e-9) == Approx(2).margin(1e-4));
  CHECK(sweep.at(3.0) == 2);
}

TEST_CASE("a trajectory is linear between rows and constant outside") {
  const TemporaryFile file(
      "time_s,flexor.mode,flexor.reference\n0,force,10\n1,force,20\n2,force,20\n");
  const reference::Trajectory trajectory(file.path);
  const auto& column = trajectory.columns().at(0);
  CHECK(column.at(-1) == 10);
  CHECK(column.at(0.25) == Approx(12.5));
  CHECK(column.at(9) == 20);
  CHECK(column.mode_at(0.5) == erp::Mode::force);
  CHECK(trajectory.duration_s() == 2);
}

TEST_CASE("a trajectory without modes or with unknown actuators is refused by name") {
  const TemporaryFile file("time_s,flexor.reference\n0,10\n");
  CHECK_THROWS_WITH(reference::Trajectory(file.path), Catch::Contains("flexor.mode"));
  reference::Params params;
  params.signals = {signal(Shape::step)};
  params.signals[0].actuator = "flexr";
  CHECK_THROWS_WITH(reference::Reference<erp::ActuatorCommand>(params, one_muscle()),
                    Catch::Contains("flexr"));
}

TEST_CASE("a reference gives the signal at the elapsed time for each frame") {
  reference::Params params;
  params.signals = {signal(Shape::step)};
  reference::Reference<erp::ActuatorCommand> reference(params, one_muscle());
  const erp::SensorFrame frame;
  CHECK(reference.step(frame, 0).actuators._buffer[0].reference == 2);
  CHECK(reference.step(frame, 0.9).actuators._buffer[0].reference == 2);
  CHECK(reference.step(frame, 0.2).actuators._buffer[0].reference == 40);
}
