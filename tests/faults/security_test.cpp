// A participant without a certificate of the robot's authority neither commands nor receives.
#include <dds/ddsrt/log.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "tests/faults/row.hpp"
#include "tests/system/background.hpp"
#include "tests/system/recorded.hpp"

using namespace tests;

namespace {

/// Results of an intruder after three seconds; a partner with a certificate needs half a second.
struct Result {
  int readers = -1, writers = -1, received = -1, after_ms = 0;
  bool nothing() const { return readers == 0 && writers == 0 && received == 0; }
  bool driven() const { return readers > 0; }
  bool listened() const { return writers > 0 && received > 100; }
};

Result intrude(const std::string& security, const std::string& claims_to_be = "") {
  const auto message = run((security.empty() ? "" : "ERP_SECURITY=" + security + " ") +
                        ERP_INTRUDER " configs/hinge_rig/robot.xml 3 " + claims_to_be);
  INFO(message.output);
  REQUIRE(message.exit_code == 0);
  Result result;
  std::istringstream words(message.output.substr(message.output.rfind("readers ")));
  std::string word;
  words >> word >> result.readers >> word >> result.writers >> word >> result.received >> word >>
      result.after_ms;
  return result;
}

/// A tendon's step from 2 to 40 N, on a bus that is protected or not.
class Rig {
 public:
  explicit Rig(const std::string& security)
      : graph_(words(security, folder_ / "run"), folder_ / "out.txt") {
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
  int samples() const {
    int found = 0;
    const Recorded commands(recording(), "actuator_command");
    for (const auto& message : commands.messages())
      found += text(message, "controller") == "intruder";
    return found;
  }
  /// Whether the plant processed any: accepted or rejected.
  bool taken() const {
    bool found = false;
    const Recorded owners(recording(), "actuator_owner");
    REQUIRE(owners.messages().size() > 20);
    for (const auto& message : owners.messages())
      for (const auto& actuator : elements(message, "actuators"))
        found = found || text(*actuator.members(), "owner") == "intruder" ||
                number(*actuator.members(), "refused") > 0;
    return found;
  }
  /// The largest distance of the flexor's tension from its 40 N in the run's last second.
  double error_N() const {
    const Recorded frames(recording(), "sensor_frame");
    const double end_ns = number(frames.messages().back(), "stamp_ns");
    double largest = 0;
    for (const auto& frame : frames.messages())
      for (const auto& actuator : elements(frame, "actuators"))
        if (text(*actuator.members(), "name") == "flexor" &&
            number(frame, "stamp_ns") > end_ns - 1e9)
          largest = std::max(largest, std::abs(number(*actuator.members(), "tension_N") - 40));
    return largest;
  }

 private:
  static std::vector<std::string> words(const std::string& security, const std::string& out) {
    std::vector<std::string> words{"launch", "launch/force_step.xml", "--out", out};
    if (!security.empty()) words.insert(words.end(), {"--security", security});
    return words;
  }
  Folder folder_;
  Background graph_;
};

/// A robot's authority, and another one.
struct Authorities {
  Folder folder;
  std::string own = folder / "own", foreign = folder / "foreign";
  Authorities() {
    // Earlier tests of this process also try to join the bus: DDS reports each refusal.
    dds_set_log_sink([](void*, const dds_log_data_t*) {}, nullptr);
    for (const auto& made : {own, foreign})
      REQUIRE(run("erp security make " + made).exit_code == 0);
  }
};

}  // namespace

TEST_CASE("an intruder commands and receives an unprotected graph") {
  Rig rig("");
  const Result result = intrude("");
  rig.stop();
  CHECK(result.driven());
  CHECK(result.listened());
  CHECK(rig.samples() > 100);
  CHECK(rig.taken());
}

TEST_CASE(
    "without a certificate of the robot's authority an intruder neither commands nor receives") {
  const Authorities authorities;
  Rig rig(authorities.own);
  int succeeded = 0;
  for (int k = 0; k < faults::injections(); ++k)
    for (const auto& certificate : {std::string(), authorities.foreign}) {
      const Result result = intrude(certificate, k % 2 ? "plant" : "");
      INFO((certificate.empty() ? "no certificate" : "another authority's certificate"));
      CHECK(result.nothing());
      succeeded += !result.nothing();
    }
  rig.stop();
  INFO(rig.output());
  CHECK(rig.samples() == 0);
  CHECK_FALSE(rig.taken());
  CHECK(rig.error_N() < 2);
  CHECK(rig.output().find("restarted") == std::string::npos);
  std::printf("| unauthorised publisher | succeeded | %d of %d |\n", succeeded,
              2 * faults::injections());
}

TEST_CASE("the same intruder with the robot's own certificate is accepted") {
  const Authorities authorities;
  Rig rig(authorities.own);
  const Result result = intrude(authorities.own);
  rig.stop();
  CHECK(result.driven());
  CHECK(result.listened());
  CHECK(rig.samples() > 100);
  CHECK(rig.taken());
}
