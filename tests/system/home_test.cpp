// Encoders that have lost their zero: resets of ECUs in mid-run and unknown zeros at the start, in the
// simulator and over CAN.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <optional>

#include "firmware/core/ecu.h"
#include "interfaces/robot/robot.hpp"
#include "tests/system/background.hpp"
#include "tests/system/recorded.hpp"

using namespace tests;

namespace {

/// The report of one ECU channel in one frame.
struct Report {
  bool zero_known;
  double counts, duty, tension_counts;
  int request;  ///< of firmware/core/ecu.h
};

std::vector<Report> reports_of(const std::string& recording, std::size_t actuator) {
  std::vector<Report> reports;
  const Recorded frames(recording, "ecu_frame");
  for (const auto& frame : frames.messages()) {
    const auto& channel = *elements(frame, "channels")[actuator].members();
    reports.push_back({std::get<bool>(channel.find("zero_known")->data),
                       number(channel, "encoder_counts"), number(channel, "duty_counts"),
                       number(channel, "tension_counts"),
                       static_cast<int>(number(channel, "request"))});
  }
  return reports;
}

double line_m_per_count(const erp::Robot& robot, std::size_t actuator) {
  const auto& a = robot.actuators[actuator];
  return a.spindle.radius_m * 2 * std::numbers::pi /
         (robot.sensors_of(a).encoder_counts_per_rev * robot.motor_of(a).gear_ratio);
}

/// What happened to an encoder: counts at the reset (0: none), the mode in which its motor was first
/// driven while the zero was unknown, and the counts that the new zero added.
struct Loss {
  double before_counts = 0;
  std::optional<int> first_mode;
  std::optional<double> added_counts;
};

Loss loss_of(const std::vector<Report>& reports) {
  Loss loss;
  for (std::size_t k = 1; k < reports.size(); ++k) {
    const auto &last = reports[k - 1], &now = reports[k];
    if (last.zero_known && !now.zero_known) loss.before_counts = last.counts;
    if (!now.zero_known && now.duty != 0 && !loss.first_mode) loss.first_mode = now.request;
    if (!last.zero_known && now.zero_known) loss.added_counts = now.counts - last.counts;
  }
  return loss;
}

double tension_N(const Report& report, const erp::SensorType& sensors) {
  const double zero = sensors.tension_zero_counts;
  return (report.tension_counts - zero) * sensors.tension_range_N /
         (std::exp2(sensors.tension_bits) - 1 - zero);
}

std::string bus() { return "udp:239.255.42.9:" + std::to_string(22000 + own_domain); }

/// A graph that the test writes and starts; `controllers` are its component elements.
struct Started {
  Folder folder;
  std::optional<Background> graph;
  std::string recording = folder / "run.mcap";

  Started(const std::string& robot, const std::string& sim, const std::string& controllers,
          const std::vector<std::string>& options = {}) {
    std::ofstream(folder / "sim.xml") << sim;
    std::ofstream(folder / "graph.xml")
        << "<graph name=\"home\" robot=\"" ERP_SOURCE_DIR "/configs/" << robot
        << "/robot.xml\" device=\"sim\">\n<component name=\"sim\" config=\"sim.xml\"/>\n"
        << controllers << "<component name=\"logger\"/>\n</graph>\n";
    std::vector<std::string> arguments{"launch", folder / "graph.xml",      "--out", folder / "run",
                                       "--set",  "logger.file=" + recording};
    arguments.insert(arguments.end(), options.begin(), options.end());
    graph.emplace(arguments, folder / "out.txt");
    REQUIRE(graph->wait_for_output("all components are active"));
  }
};

std::string under_length_control(const std::string& robot) {
  const std::string folder = ERP_SOURCE_DIR "/configs/" + robot;
  return "<component name=\"target\" config=\"" + folder + "/target.xml\"/>\n" +
         "<component name=\"length_control\" config=\"" + folder + "/length_control.xml\"/>\n";
}

std::vector<std::string> over_can() {
  return {"--device", "can", "--set", "gateway.bus=" + bus(), "--set", "sim.bus=" + bus()};
}

/// Homes a robot; checks the errors of its lines, and the tensions.
void check_homing(const std::string& name, double largest_error_m) {
  const erp::Robot robot = erp::read_robot(ERP_SOURCE_DIR "/configs/" + name + "/robot.xml");
  Started run(name, "<sim/>", "");
  const auto homed = ::run("erp home --all");
  INFO(homed.output);
  CHECK(homed.exit_code == 0);
  CHECK(run.graph->stop() == 0);
  for (std::size_t a = 0; a < robot.actuators.size(); ++a) {
    const auto reports = reports_of(run.recording, a);
    const auto& sensors = robot.sensors_of(robot.actuators[a]);
    const double start_N = tension_N(reports.front(), sensors);
    double largest_N = 0, added_counts = 0;
    for (std::size_t k = 1; k < reports.size(); ++k) {
      largest_N = std::max(largest_N, tension_N(reports[k], sensors));
      if (!reports[k - 1].zero_known && reports[k].zero_known)
        added_counts = reports[k].counts - reports[k - 1].counts;
    }
    CAPTURE(robot.actuators[a].name, start_N, largest_N);
    CHECK(std::abs(added_counts) * line_m_per_count(robot, a) < largest_error_m);
    CHECK(largest_N < std::max(15.0, start_N + 1));
  }
}

}  // namespace

TEST_CASE("an ECU that resets with its line wound does not wind again; erp home sets its zero") {
  for (const bool can : {false, true}) {
    CAPTURE(can);
    const erp::Robot leg = erp::read_robot(ERP_SOURCE_DIR "/configs/leg/robot.xml");
    Started run("leg", R"(<sim><fault kind="reset" on="iliopsoas" at_s="6"/></sim>)",
                under_length_control("leg"), can ? over_can() : std::vector<std::string>{});
    REQUIRE(run.graph->wait_for_output("the zero of its encoder is unknown after a reset"));
    std::this_thread::sleep_for(2s);
    const auto homed = ::run("erp home");
    INFO(homed.output);
    CHECK(homed.exit_code == 0);
    CHECK(run.graph->wait_for_output("the zero of its encoder is set from erp_home"));
    std::this_thread::sleep_for(1s);
    CHECK(run.graph->stop() == 0);
    std::size_t lost = 0;
    for (std::size_t a = 0; a < leg.actuators.size(); ++a) {
      const auto reports = reports_of(run.recording, a);
      const Loss loss = loss_of(reports);
      if (!loss.added_counts) continue;
      ++lost;
      const double scale_m = line_m_per_count(leg, a);
      CAPTURE(leg.actuators[a].name, loss.before_counts, *loss.added_counts);
      CHECK(loss.first_mode == ECU_REQUEST_FORCE);  // by erp home, which may then take up slack
      CHECK(std::abs(*loss.added_counts - loss.before_counts) * scale_m < 0.0005);
      CHECK(reports.back().zero_known);
      CHECK(reports.back().request == ECU_REQUEST_LENGTH);
    }
    CHECK(lost >= 1);
  }
}

TEST_CASE("an actuator with a potentiometer resumes by itself after a reset of its ECU") {
  const erp::Robot rod = erp::read_robot(ERP_SOURCE_DIR "/configs/pendulum/robot.xml");
  for (const bool can : {false, true}) {
    CAPTURE(can);
    Started run("pendulum", R"(<sim><fault kind="reset" on="muscle_1" at_s="4"/></sim>)",
                under_length_control("pendulum"), can ? over_can() : std::vector<std::string>{});
    CHECK(run.graph->wait_for_output("the zero of its encoder is set from its potentiometer"));
    std::this_thread::sleep_for(2s);
    CHECK(run.graph->stop() == 0);
    const auto reports = reports_of(run.recording, 0);
    const Loss loss = loss_of(reports);
    REQUIRE(loss.added_counts);
    CHECK_FALSE(loss.first_mode);
    const double scale_m = line_m_per_count(rod, 0);
    CHECK(std::abs(*loss.added_counts - loss.before_counts) * scale_m < 0.0005);
    CHECK(reports.back().request == ECU_REQUEST_LENGTH);
  }
}

TEST_CASE(
    "with unknown zeros at the start the plant assumes the starting pose, or erp home is told") {
  Started run("hinge_rig", R"(<sim zeros="unknown"/>)", "");
  CHECK(run.graph->wait_for_output("the zero of its encoder is set from the starting pose"));
  const auto known = ::run("erp home");
  CHECK(known.exit_code == 0);
  CHECK(known.output.find("the zeros of all encoders are known") != known.output.npos);
  const auto here = ::run("erp home --here --all");
  INFO(here.output);
  CHECK(here.exit_code == 0);
  CHECK(::run("erp home nobody").exit_code == 2);
  CHECK(run.graph->stop() == 0);
  for (std::size_t a = 0; a < 2; ++a) {
    const auto reports = reports_of(run.recording, a);
    CHECK(reports.back().zero_known);
    CHECK(reports.back().counts == Approx(0).margin(3));
  }
}

TEST_CASE("robot.xml can let erp launch home the robot at the start") {
  Folder folder;
  std::string xml = content(ERP_SOURCE_DIR "/configs/hinge_rig/robot.xml");
  const std::string name = "<robot name=\"hinge_rig\" switched_on=\"starting_pose\"";
  REQUIRE(xml.find(name) != xml.npos);
  xml.replace(xml.find(name), name.size(), "<robot name=\"hinge_rig\" homing=\"at_start\"");
  std::ofstream(folder / "robot.xml") << xml;
  std::ofstream(folder / "graph.xml")
      << "<graph name=\"home\" robot=\"robot.xml\" device=\"sim\"/>\n";
  Background graph(
      {"launch", folder / "graph.xml", "--out", folder / "run", "--set", "sim.zeros=unknown"},
      folder / "out.txt");
  CHECK(graph.wait_for_output("the zero of its encoder is set from erp_home"));
  CHECK(graph.wait_for_output("home: flexor: line "));
  CHECK(graph.stop() == 0);
}

TEST_CASE(
    "with a sensor on every joint, homing finds the lines to 0.1 mm, at tensions below 15 N") {
  check_homing("seven_dof", 0.0001);
}

TEST_CASE("without a sensor in the shoulder, homing moves the arm and finds the lines to 0.5 mm") {
  check_homing("arm", 0.0005);
}
