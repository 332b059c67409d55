// Who was not given a certificate of the robot's authority neither drives it nor hears it.
#include <dds/ddsrt/log.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "tests/faults/row.hpp"
#include "tests/system/background.hpp"
#include "tests/system/recorded.hpp"

using namespace tests;

namespace {

/// What an intruder got in three seconds: a partner with a certificate needs half of one.
struct Loot {
  int readers = -1, writers = -1, heard = -1, after_ms = 0;
  bool nothing() const { return readers == 0 && writers == 0 && heard == 0; }
  bool driven() const { return readers > 0; }
  bool listened() const { return writers > 0 && heard > 100; }
};

Loot intrude(const std::string& security, const std::string& claims_to_be = "") {
  const auto said = run((security.empty() ? "" : "ERP_SECURITY=" + security + " ") +
                        ERP_INTRUDER " configs/hinge_rig/robot.xml 3 " + claims_to_be);
  INFO(said.output);
  REQUIRE(said.exit_code == 0);
  Loot loot;
  std::istringstream words(said.output.substr(said.output.rfind("readers ")));
  std::string word;
  words >> word >> loot.readers >> word >> loot.writers >> word >> loot.heard >> word >>
      loot.after_ms;
  return loot;
}

/// A tendon's step from 2 to 40 N, on a bus that is protected or not.
class Rig {
 public:
  explicit Rig(const std::string& security)
      : graph_(words(security, folder_ / "run"), folder_ / "out.txt") {
    REQUIRE(graph_.says("all components are active"));
  }
  void stop() {
    const auto children = graph_.children();
    CHECK(graph_.stop() == 0);
    INFO(graph_.output());
    for (const auto child : children) CHECK(kill(child, 0) != 0);
  }
  std::string output() const { return graph_.output(); }
  std::string recording() const { return folder_ / "run/force_step.mcap"; }

  /// How many commands of the intruder were heard.
  int samples() const {
    int found = 0;
    const Recorded commands(recording(), "actuator_command");
    for (const auto& message : commands.messages())
      found += text(message, "controller") == "intruder";
    return found;
  }
  /// Whether the plant took any: let it drive, or refused it.
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
    // This process knocks at the bus as well, from earlier tests: DDS tells of each refusal.
    dds_set_log_sink([](void*, const dds_log_data_t*) {}, nullptr);
    for (const auto& made : {own, foreign})
      REQUIRE(run("erp security make " + made).exit_code == 0);
  }
};

}  // namespace

TEST_CASE("an intruder drives and hears a graph that nothing protects") {
  Rig rig("");
  const Loot loot = intrude("");
  rig.stop();
  CHECK(loot.driven());
  CHECK(loot.listened());
  CHECK(rig.samples() > 100);
  CHECK(rig.taken());
}

TEST_CASE("without a certificate of the robot's authority nobody drives or hears it") {
  const Authorities authorities;
  Rig rig(authorities.own);
  int got_through = 0;
  for (int k = 0; k < faults::injections(); ++k)
    for (const auto& certificate : {std::string(), authorities.foreign}) {
      const Loot loot = intrude(certificate, k % 2 ? "plant" : "");
      INFO((certificate.empty() ? "no certificate" : "another authority's certificate"));
      CHECK(loot.nothing());
      got_through += !loot.nothing();
    }
  rig.stop();
  INFO(rig.output());
  CHECK(rig.samples() == 0);
  CHECK_FALSE(rig.taken());
  CHECK(rig.error_N() < 2);
  CHECK(rig.output().find("restarted") == std::string::npos);
  std::printf("| unauthorised publisher | got through | %d of %d |\n", got_through,
              2 * faults::injections());
}

TEST_CASE("the same intruder with the robot's own certificate is let in") {
  const Authorities authorities;
  Rig rig(authorities.own);
  const Loot loot = intrude(authorities.own);
  rig.stop();
  CHECK(loot.driven());
  CHECK(loot.listened());
  CHECK(rig.samples() > 100);
  CHECK(rig.taken());
}
