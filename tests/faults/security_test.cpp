// A participant without a certificate of the robot's authority neither commands nor receives.
#include <dds/ddsrt/log.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "tests/faults/reaction_times.hpp"
#include "tests/system/background.hpp"
#include "tests/system/recorded.hpp"

using namespace tests;

namespace {

/// Results of an intruder after three seconds; a partner with a certificate needs half a second.
struct Result {
  int readers = -1, writers = -1, received = -1, after_ms = 0;
  bool is_isolated() const { return readers == 0 && writers == 0 && received == 0; }
  bool commands_robot() const { return readers > 0; }
  bool receives_frames() const { return writers > 0 && received > 100; }
};

Result intrude(const std::string& security, const std::string& claimed_name = "") {
  const auto message = run((security.empty() ? "" : "ERP_SECURITY=" + security + " ") +
                           ERP_INTRUDER " configs/hinge_rig/robot.xml 3 " + claimed_name);
  INFO(message.output);
  REQUIRE(message.exit_code == 0);
  Result result;
  std::istringstream fields(message.output.substr(message.output.rfind("readers ")));
  std::string word;
  fields >> word >> result.readers >> word >> result.writers >> word >> result.received >> word >>
      result.after_ms;
  return result;
}

/// A tension step of a tendon from 2 to 40 N, on a bus with or without protection.
class Rig {
 public:
  explicit Rig(const std::string& security)
      : graph_(arguments(security, folder_ / "run"), folder_ / "out.txt") {
    REQUIRE(graph_.wait_for_output("all components are active"));
  }
  void stop() {
    const auto children = graph_.children();
    CHECK(graph_.stop() == 0);
    INFO(graph_.output());
    for (const auto child : children) CHECK(kill(child, 0) != 0);
  }
  std::string output() const { return graph_.output(); }
  std::string recording() const { return folder_ / "run/force_step.mcap"; }

  /// Number of received commands of the intruder.
  int intruder_commands() const {
    int count = 0;
    const Recorded commands(recording(), "actuator_command");
    for (const auto& message : commands.messages())
      count += text(message, "controller") == "intruder";
    return count;
  }
  /// True if the plant accepted or rejected a command of the intruder.
  bool was_processed() const {
    bool is_processed = false;
    const Recorded owners(recording(), "actuator_owner");
    REQUIRE(owners.messages().size() > 20);
    for (const auto& message : owners.messages())
      for (const auto& actuator : elements(message, "actuators"))
        is_processed = is_processed || text(*actuator.members(), "owner") == "intruder" ||
                       number(*actuator.members(), "refused") > 0;
    return is_processed;
  }
  /// Largest difference of the flexor's tension from 40 N in the last second of the run.
  double error_N() const {
    const Recorded frames(recording(), "sensor_frame");
    const double end_ns = number(frames.messages().back(), "stamp_ns");
    double largest_N = 0;
    for (const auto& frame : frames.messages())
      for (const auto& actuator : elements(frame, "actuators"))
        if (text(*actuator.members(), "name") == "flexor" &&
            number(frame, "stamp_ns") > end_ns - 1e9)
          largest_N = std::max(largest_N, std::abs(number(*actuator.members(), "tension_N") - 40));
    return largest_N;
  }

 private:
  static std::vector<std::string> arguments(const std::string& security, const std::string& out) {
    std::vector<std::string> arguments{"launch", "launch/force_step.xml", "--out", out};
    if (!security.empty()) arguments.insert(arguments.end(), {"--security", security});
    return arguments;
  }
  Folder folder_;
  Background graph_;
};

/// A robot's authority, and another one.
struct Authorities {
  Folder folder;
  std::string own_folder = folder / "own", foreign_folder = folder / "foreign";
  Authorities() {
    // Earlier tests of this process also try to join the bus: DDS reports each refusal.
    dds_set_log_sink([](void*, const dds_log_data_t*) {}, nullptr);
    for (const auto& folder_name : {own_folder, foreign_folder})
      REQUIRE(run("erp security make " + folder_name).exit_code == 0);
  }
};

}  // namespace

TEST_CASE("in an unprotected graph an intruder's commands are accepted and it receives frames") {
  Rig rig("");
  const Result result = intrude("");
  rig.stop();
  CHECK(result.commands_robot());
  CHECK(result.receives_frames());
  CHECK(rig.intruder_commands() > 100);
  CHECK(rig.was_processed());
}

TEST_CASE(
    "without a certificate of the robot's authority an intruder neither commands nor receives") {
  const Authorities authorities;
  Rig rig(authorities.own_folder);
  int succeeded = 0;
  for (int k = 0; k < faults::injections(); ++k)
    for (const auto& certificate : {std::string(), authorities.foreign_folder}) {
      const Result result = intrude(certificate, k % 2 ? "plant" : "");
      INFO((certificate.empty() ? "no certificate" : "another authority's certificate"));
      CHECK(result.is_isolated());
      succeeded += !result.is_isolated();
    }
  rig.stop();
  INFO(rig.output());
  CHECK(rig.intruder_commands() == 0);
  CHECK_FALSE(rig.was_processed());
  CHECK(rig.error_N() < 2);
  CHECK(rig.output().find("restarted") == std::string::npos);
  std::printf("| unauthorised publisher | succeeded | %d of %d |\n", succeeded,
              2 * faults::injections());
}

TEST_CASE("an intruder with the robot's own certificate is accepted") {
  const Authorities authorities;
  Rig rig(authorities.own_folder);
  const Result result = intrude(authorities.own_folder);
  rig.stop();
  CHECK(result.commands_robot());
  CHECK(result.receives_frames());
  CHECK(rig.intruder_commands() > 100);
  CHECK(rig.was_processed());
}

TEST_CASE("an identity writes only the topics of its role") {
  const Authorities authorities;
  Rig rig(authorities.own_folder);
  const auto roles = authorities.own_folder + "/roles/";

  const auto heard =
      run("ERP_SECURITY=" + roles + "listener erp echo sensor_frame --for 3s | wc -l");
  CHECK(std::stol(heard.output) > 100);
  const auto sent = run("ERP_SECURITY=" + roles + "listener erp send flexor force 5 --for 1s");
  INFO(sent.output);
  CHECK(sent.exit_code != 0);
  CHECK(sent.output.find("may not write") != std::string::npos);

  // A controller commands the plant, but cannot pose as a device or as the plant, nor set gains.
  CHECK(intrude(roles + "controller").commands_robot());
  for (const std::string program : {"plant", "sim"}) {
    const auto started = run("ERP_SECURITY=" + roles + "controller " + program +
                             " --robot configs/hinge_rig/robot.xml --name other");
    INFO(started.output);
    CHECK(started.exit_code != 0);
    CHECK(started.output.find("may not write") != std::string::npos);
  }
  const auto gains =
      run("ERP_SECURITY=" + roles + "controller erp set flexor force_gain_V_per_A=0.1");
  CHECK(gains.output.find("may not write gain_command") != std::string::npos);
  const auto by_operator =
      run("ERP_SECURITY=" + authorities.own_folder + " erp send flexor force 5 --for 1s");
  INFO(by_operator.output);
  CHECK(by_operator.exit_code == 0);
  rig.stop();
}

TEST_CASE("permissions of another role are refused: they are issued to another certificate") {
  const Authorities authorities;
  Rig rig(authorities.own_folder);
  const auto roles = authorities.own_folder + "/roles/";
  std::filesystem::copy_file(roles + "controller/permissions.p7s",
                             roles + "listener/permissions.p7s",
                             std::filesystem::copy_options::overwrite_existing);
  const auto message =
      run("ERP_SECURITY=" + roles + "listener " ERP_INTRUDER " configs/hinge_rig/robot.xml 3");
  INFO(message.output);
  CHECK((message.exit_code != 0 || message.output.find("readers 0 ") != std::string::npos));
  rig.stop();
}
