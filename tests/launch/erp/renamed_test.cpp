// Former names of XML, JSON and the command line still work, each with one warning.
#include <catch2/catch.hpp>
#include <vector>

#include "tests/system/command.hpp"

using Catch::Matchers::Contains;

namespace {

struct Result {
  int code;
  std::string text;  ///< stdout and stderr
};

/// A temporary folder, in which programs are run.
class Folder : public tests::Folder {
 public:
  std::string file(const std::string& name, const std::string& text) const {
    std::ofstream(*this / name) << text;
    return *this / name;
  }
  /// `arguments`: free of characters that the shell replaces.
  Result run(const std::vector<std::string>& arguments) const {
    std::string command;
    for (const auto& argument : arguments) command += argument + " ";
    const auto outcome = tests::run(command);
    return {outcome.exit_code, outcome.output};
  }
};

std::string config(const std::string& name) { return ERP_SOURCE_DIR "/configs/" + name; }

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (auto k = text.find(part); k != text.npos; k = text.find(part, k + 1)) ++found;
  return found;
}

std::size_t warnings(const Result& result) { return count(result.text, "warning: "); }

std::string diagnosis(const std::string& confounders, const std::string& fix_first) {
  const std::string effects =
      R"([{"type": "gearbox_coulomb", "on": "flexor", "supported": true, "parameters": {"extra_Nm": 0.05}},
          {"type": "gearbox_viscous", "on": "flexor", "supported": true,
           "parameters": {"extra_Nm_s_per_rad": 0.02}}])";
  return R"({"robot": "hinge_rig", "verdict": "supported", "effects": )" + effects + ", \"" +
         confounders + "\": " + effects + ", \"" + fix_first + R"(": ["flexor.current_A"]})";
}

}  // namespace

TEST_CASE("a sim config with <grasp> and <mishap> is valid; each former name is reported once") {
  const Folder folder;
  const auto file =
      folder.file("sim.xml",
                  "<sim>\n"
                  "  <grasp body=\"forearm\" at_m=\"0 0 0\" mass_kg=\"1\" at_s=\"1\"/>\n"
                  "  <grasp body=\"forearm\" at_m=\"0 0 0\" mass_kg=\"1\" at_s=\"2\"/>\n"
                  "  <mishap kind=\"tendon_snaps\" on=\"flexor\" at_s=\"1\"/>\n"
                  "</sim>\n");
  const Result former = folder.run({"erp", "check", file});
  INFO(former.text);
  CHECK(former.code == 0);
  CHECK(warnings(former) == 2);
  CHECK_THAT(former.text,
             Contains("warning: " + file + ":2:3: <grasp> is deprecated; write <attached_load>\n"));
  CHECK_THAT(former.text, Contains(file + ":4:3: <mishap> is deprecated; write <fault>\n"));
  const Result current = folder.run({"erp", "check", config("twin_joint/sim_attached_load.xml")});
  CHECK(current.code == 0);
  CHECK(warnings(current) == 0);
}

TEST_CASE("a learned map with its former root element and attribute is valid; each is reported") {
  const Folder folder;
  const auto file = folder.file("before.xml",
                                "<sensorimotor_learnt squares=\"1 1\">\n"
                                "  <sense ties=\"1 2\"/>\n  <sense ties=\"3 4\"/>\n"
                                "</sensorimotor_learnt>\n");
  const Result former = folder.run({"erp", "check", file});
  INFO(former.text);
  CHECK(former.code == 0);
  CHECK(warnings(former) == 2);
  CHECK_THAT(former.text,
             Contains(":1:1: <sensorimotor_learnt> is deprecated; write <sensorimotor_learned>"));
  CHECK_THAT(former.text, Contains(":2:10: \"ties\" is deprecated; write \"weights\""));
}

TEST_CASE("a former parameter is set by --set and by a config, with a warning") {
  const Folder folder;
  const Result set =
      folder.run({"computed_force", "--set", "liking=smooth", "--set", "anticipate=0", "--check"});
  INFO(set.text);
  CHECK(set.code == 0);
  CHECK(set.text ==
        "warning: --set liking=smooth: \"liking\" is deprecated; write \"objective\"\n"
        "warning: --set anticipate=0: \"anticipate\" is deprecated; write \"lag_compensation\"\n");
  CHECK(folder.run({"computed_force", "--set", "liking=smoth", "--check"}).code == 2);
  const auto file = folder.file("config.xml", "<computed_force liking=\"smooth\"/>");
  const Result read = folder.run({"computed_force", "--config", file, "--check"});
  CHECK(read.code == 0);
  CHECK(read.text == "warning: " + file + ":1:17: \"liking\" is deprecated; write \"objective\"\n");
}

TEST_CASE("an attribute given under both names is rejected") {
  const Folder folder;
  const auto file =
      folder.file("config.xml", "<computed_force liking=\"smooth\" objective=\"smooth\"/>");
  const Result both = folder.run({"computed_force", "--config", file, "--check"});
  CHECK(both.code == 2);
  CHECK_THAT(both.text, Contains("unknown attribute \"liking\""));
}

TEST_CASE("a diagnosis.json of format 1 gives the same plan, with one warning per former key") {
  const Folder folder;
  const auto plan = [&](const std::string& file) {
    return folder.run({"erp", "gap", "plan", "--robot", config("hinge_rig/robot.xml"),
                       "--diagnosis", file, "--out", folder / "next", "--seconds", "4",
                       "--candidates", "3"});
  };
  const auto file = folder.file("old.json", diagnosis("confusable", "mend_first"));
  const Result former = plan(file);
  INFO(former.text);
  REQUIRE(former.code == 0);
  CHECK(warnings(former) == 2);
  CHECK_THAT(former.text, Contains(file + ": \"mend_first\" is deprecated; write \"fix_first\"\n"));
  CHECK_THAT(former.text,
             Contains(file + ": \"confusable\" is deprecated; write \"confounders\"\n"));
  CHECK_THAT(former.text, Contains("fix its recordings first"));
  const Result current = plan(folder.file("new.json", diagnosis("confounders", "fix_first")));
  CHECK(current.code == 0);
  CHECK(warnings(current) == 0);
  CHECK(former.text.substr(former.text.find("suspects ")) ==
        current.text.substr(current.text.find("suspects ")));
}

TEST_CASE("erp gap twins --together lists confounders with two warnings; --help lists neither") {
  const Folder folder;
  const auto list = [&](const std::string& verb, const std::string& option) {
    return folder.run({"erp", "gap", verb, "--robot", config("hinge_rig/robot.xml"), "--seconds",
                       "4", option, "1"});
  };
  const Result former = list("twins", "--together");
  INFO(former.text);
  CHECK(former.code == 0);
  CHECK(warnings(former) == 2);
  CHECK_THAT(former.text,
             Contains("warning: erp gap: \"twins\" is deprecated; write \"confounders\"\n"));
  CHECK_THAT(former.text, Contains("\"--together\" is deprecated; write \"--max-effects\"\n"));
  const Result current = list("confounders", "--max-effects");
  CHECK(current.code == 0);
  CHECK(warnings(current) == 0);
  CHECK_THAT(former.text, Contains("routing_pulley_radius on flexor"));
  CHECK_THAT(current.text, Contains("routing_pulley_radius on flexor"));
  CHECK_THAT(folder.run({"erp", "gap", "--help"}).text, !Contains("twins"));
  CHECK_THAT(folder.run({"erp", "gap", "confounders", "--help"}).text, !Contains("--together"));
  const Result rejected = list("confounders", "--together=99");
  CHECK(rejected.code == 2);
}

TEST_CASE("former options of erp calibrate tour and erp launch have the effect of the new ones") {
  const Folder folder;
  const auto tour = [&](const std::string& hold, const std::string& move) {
    return folder.run({"erp", "calibrate", "tour", config("arm/lengths.csv"), hold, "3", move, "1",
                       "--out", folder / "tour.csv"});
  };
  const auto written = [&] { return tests::content(folder / "tour.csv"); };
  const Result former = tour("--still", "--way");
  INFO(former.text);
  CHECK(former.code == 0);
  CHECK(warnings(former) == 2);
  const auto first = written();
  const Result current = tour("--hold", "--move");
  CHECK(current.code == 0);
  CHECK(warnings(current) == 0);
  CHECK(first == written());
  CHECK_FALSE(first.empty());
  const Result launched = folder.run({"erp", "launch", "missing.xml", "--patience", "60s"});
  CHECK(launched.code == 2);
  CHECK_THAT(launched.text, Contains("warning: erp launch: \"--patience\" is deprecated; write "
                                     "\"--ready-timeout\"\n"));
}
