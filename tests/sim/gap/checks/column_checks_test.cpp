#include "sim/gap/checks/column_checks.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "sim/gap/residuals/drives.hpp"
#include "tests/sim/gap/residuals/rig_recording.hpp"
#include "tests/sim/rigs.hpp"

using sim::residuals::Episode;
using sim::residuals::Signal;

namespace {

erp::Robot hinge_rig() { return erp::read_robot(rigs::config("hinge_rig/robot.xml")); }

/// What is odd about a recording of the rig after such a change.
template <class Change>
std::vector<std::string> odd_after(Change change) {
  static const Episode plain = rig_recording::record(hinge_rig(), hinge_rig(), {.seconds = 8});
  Episode episode = plain;
  change(episode);
  return sim::checks::column_checks(episode, hinge_rig());
}

void scale(Signal& signal, double by) {
  for (double& x : signal) x *= by;
}

/// One thing alone is odd, and it is this.
void check_says(const std::vector<std::string>& suspicious, const char* column, const char* what) {
  REQUIRE(suspicious.size() == 1);
  CHECK_THAT(suspicious[0],
             Catch::StartsWith(std::string("run: ") + column) && Catch::Contains(what));
}

/// A voltage turns a slide of 40 kg through a motor's winding; it swings.
Episode slide_that_swings(const erp::Robot& robot) {
  constexpr double row_s = 1e-3, mass_kg = 40, gain_N = 30;
  std::vector<double> control, position, time;
  double x = 0, v = 0;
  for (int k = 0; k < 6000; ++k) {
    const double t = k * row_s, u = 2 * std::sin(5 * t) - 3 * v;
    time.push_back(t), control.push_back(u), position.push_back(x);
    v += (gain_N * u - 4 * std::tanh(v / 1e-4)) / mass_kg * row_s, x += v * row_s;
  }
  recording::Table table;
  table.columns = {{"time_s", time}, {"z.control_V", control}, {"z.position_m", position}};
  std::vector<std::string> remarks;
  return sim::residuals::lay_out(table, sim::residuals::as_chains(robot), "run", remarks);
}

}  // namespace

TEST_CASE("a recording of the rig has the signs and units that its laws foretell") {
  CHECK(odd_after([](Episode&) {}).empty());
}

TEST_CASE("wrong signs and units are told once, with what they look like") {
  const double degrees = 180 / std::numbers::pi;
  check_says(odd_after([&](Episode& e) { scale(e.actuators[0].shaft_rad, degrees); }),
             "flexor.shaft_rad", "degrees");
  check_says(odd_after([&](Episode& e) { scale(e.actuators[0].shaft_rad, 128); }),
             "flexor.shaft_rad", "before the gearbox");
  check_says(odd_after([&](Episode& e) { scale(e.actuators[0].current_A, 1000); }),
             "flexor.current_A", "thousandths");
  check_says(odd_after([&](Episode& e) { scale(e.actuators[1].voltage_V, 1000); }),
             "extensor.voltage_V", "thousandths");
  check_says(odd_after([&](Episode& e) { scale(e.actuators[0].tension_N, 1 / 9.81); }),
             "flexor.tension_N", "kilograms");
  check_says(odd_after([&](Episode& e) { scale(e.joints[0].angle_rad, degrees); }),
             "elbow.angle_rad", "degrees");
  check_says(odd_after([](Episode& e) { scale(e.actuators[0].tension_N, 0.01); }),
             "flexor.tension_N", "check its unit");
}

TEST_CASE("whichever column is turned is told, and no other") {
  const auto turned = [](auto signal_of) {
    return odd_after([&](Episode& e) { scale(signal_of(e), -1); });
  };
  for (const std::size_t a : {0U, 1U}) {
    const std::string name = a == 0 ? "flexor" : "extensor";
    check_says(turned([&](Episode& e) -> Signal& { return e.actuators[a].voltage_V; }),
               (name + ".voltage_V").c_str(), "multiply the column by -1");
    check_says(turned([&](Episode& e) -> Signal& { return e.actuators[a].current_A; }),
               (name + ".current_A").c_str(), "multiply the column by -1");
    check_says(turned([&](Episode& e) -> Signal& { return e.actuators[a].shaft_rad; }),
               (name + ".shaft_rad").c_str(), "multiply the column by -1");
    check_says(turned([&](Episode& e) -> Signal& { return e.actuators[a].tension_N; }),
               (name + ".tension_N").c_str(), "multiply the column by -1");
  }
}

TEST_CASE("of a rig that is the same on both sides, a turned elbow may be muscles exchanged") {
  const auto suspicious = odd_after([](Episode& e) { scale(e.joints[0].angle_rad, -1); });
  REQUIRE(suspicious.size() == 1);
  CHECK_THAT(suspicious[0], Catch::Contains("elbow.angle_rad: its sign") &&
                                Catch::Contains("; or flexor and extensor: all their columns"));
}

TEST_CASE("channels that were exchanged are told as such") {
  check_says(
      odd_after([](Episode& e) { std::swap(e.actuators[0].tension_N, e.actuators[1].tension_N); }),
      "flexor.tension_N and extensor.tension_N", "exchange");
  check_says(
      odd_after([](Episode& e) { std::swap(e.actuators[0].shaft_rad, e.actuators[1].shaft_rad); }),
      "flexor.shaft_rad and extensor.shaft_rad", "exchange");
  check_says(
      odd_after([](Episode& e) { std::swap(e.actuators[1].tension_N, e.actuators[1].current_A); }),
      "extensor.current_A and extensor.tension_N", "exchange");
}

TEST_CASE("two things wrong are both told") {
  const auto suspicious = odd_after([](Episode& e) {
    scale(e.actuators[0].voltage_V, -1), scale(e.actuators[1].tension_N, 1000);
  });
  REQUIRE(suspicious.size() == 2);
  CHECK_THAT(suspicious[0] + suspicious[1],
             Catch::Contains("flexor.voltage_V") && Catch::Contains("extensor.tension_N"));
}

TEST_CASE("the same thing wrong on both sides is told of both, not of one or the other") {
  const auto suspicious = odd_after([](Episode& e) {
    for (auto& actuator : e.actuators) scale(actuator.current_A, 1000);
  });
  REQUIRE(suspicious.size() == 2);
  CHECK_THAT(suspicious[0],
             Catch::Contains("flexor.current_A: 1000 times") && !Catch::Contains("; or "));
  CHECK_THAT(suspicious[1], Catch::Contains("extensor.current_A: 1000 times"));
}

TEST_CASE("what is a third too small looks like no unit") {
  CHECK(odd_after([](Episode& e) { scale(e.actuators[0].tension_N, 0.3); }).empty());
}

TEST_CASE("a column that stands still while the others move is told, and blames no other") {
  const auto stuck = [](auto signal_of, double value) {
    return odd_after([&](Episode& e) { std::ranges::fill(signal_of(e), value); });
  };
  check_says(stuck([](Episode& e) -> Signal& { return e.actuators[0].voltage_V; }, 0),
             "flexor.voltage_V is 0 all the time", "looks dead");
  check_says(stuck([](Episode& e) -> Signal& { return e.actuators[0].current_A; }, 0.1),
             "flexor.current_A is 0.1 all the time", "looks dead");
  check_says(stuck([](Episode& e) -> Signal& { return e.actuators[1].shaft_rad; }, 0),
             "extensor.shaft_rad", "looks dead");
  check_says(stuck([](Episode& e) -> Signal& { return e.actuators[1].tension_N; }, 0),
             "extensor.tension_N", "looks dead");
  check_says(stuck([](Episode& e) -> Signal& { return e.joints[0].angle_rad; }, 0.2),
             "elbow.angle_rad", "looks dead");
  check_says(odd_after([](Episode& e) {
               auto& current = e.actuators[0].current_A;
               std::fill(current.begin() + 2000, current.end(), current[2000]);
             }),
             "flexor.current_A", "from 4 s to 8 s");
}

TEST_CASE("a converter that says the same all along is told by less than one that froze") {
  const auto slowly = [](std::size_t from) {
    Episode e = rig_recording::record(hinge_rig(), hinge_rig(),
                                      {.seconds = 8, .swing_N = 2, .ripple_N = 1});
    auto& current = e.actuators[0].current_A;
    std::fill(current.begin() + std::ptrdiff_t(from), current.end(), 0.1);
    return sim::checks::column_checks(e, hinge_rig());
  };
  check_says(slowly(0), "flexor.current_A is 0.1 all the time", "looks dead");
  CHECK(slowly(500).empty());
}

TEST_CASE("a converter at the end of its range is told, one in another unit not twice") {
  const double range_N = hinge_rig().sensors_of(hinge_rig().actuators[0]).tension_range_N;
  check_says(odd_after([&](Episode& e) {
               auto& tension = e.actuators[0].tension_N;
               std::fill(tension.begin() + 1000, tension.begin() + 1100, range_N);
             }),
             "flexor.tension_N stands at the end of its range", "2.5 % of the rows");
  CHECK(odd_after([&](Episode& e) { scale(e.actuators[0].tension_N, 1000); }).size() == 1);
}

TEST_CASE("a motor that idles is not dead") {
  CHECK(odd_after([](Episode& e) {
          std::ranges::fill(e.actuators[0].voltage_V, 0);
          std::ranges::fill(e.actuators[0].current_A, 0);
        }).empty());
}

TEST_CASE("a drive's sign, unit and dead encoder are told by its inertia, in its columns' names") {
  erp::Robot robot;
  robot.name = "bench";
  erp::Drive drive;
  drive.name = "z", drive.control = erp::DriveControl::force, drive.gain = 30;
  drive.load = {erp::Slide{{}, 40, 0.01, 1e-6}};
  robot.drives = {drive};
  const auto odd_by = [&](double times) {
    Episode e = slide_that_swings(robot);
    scale(e.actuators[0].shaft_rad, times);
    return sim::checks::column_checks(e, sim::residuals::as_chains(robot));
  };
  CHECK(odd_by(1).empty());
  REQUIRE(odd_by(-1).size() == 1);
  CHECK_THAT(odd_by(-1)[0], Catch::Contains("z.position_m: its sign is against z.control_V") &&
                                Catch::Contains("; or "));
  REQUIRE(odd_by(1000).size() == 1);
  CHECK_THAT(odd_by(1000)[0],
             Catch::Contains("z.position_m: 1000 times what z.control_V foretells"));
  REQUIRE(odd_by(0).size() == 1);
  CHECK_THAT(odd_by(0)[0],
             Catch::Contains("z.position_m is 0 all the time while z.control_V moves"));
  Episode undriven = slide_that_swings(robot);
  std::ranges::fill(undriven.actuators[0].current_A, 0.5);
  const auto suspicious = sim::checks::column_checks(undriven, sim::residuals::as_chains(robot));
  REQUIRE(suspicious.size() == 1);
  CHECK_THAT(suspicious[0], Catch::Contains("z.control_V is") &&
                                Catch::Contains("all the time while z.position_m moves"));
}
