// Who may include what. The table is the rule; the test reads every include in the tree.
#include <algorithm>
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <regex>
#include <string>
#include <vector>

namespace fs = std::filesystem;

namespace {

struct Rule {
  std::string room;
  std::vector<std::string> may_include;  ///< besides itself
};

// From the bottom up: a room includes only rooms that stand above it in this table. The longest
// matching room decides. A room without a rule below components/ or sim/ is one of its own.
const std::vector<Rule> rules{
    {"interfaces/", {"interfaces/"}},
    {"firmware/core/", {}},
    {"firmware/board/", {"firmware/core/"}},
    {"hal/can/", {"interfaces/", "firmware/core/"}},
    {"hal/ecu/", {"interfaces/", "hal/can/", "firmware/"}},

    // Laws of a robot, and what controllers compute from them: no engine, bus or clock.
    {"sim/model/effects/", {"interfaces/"}},
    {"sim/model/skeleton/", {"interfaces/"}},
    {"sim/model/actuator/",
     {"interfaces/", "firmware/core/", "sim/model/effects/", "sim/model/skeleton/"}},
    {"sim/model/cameras/", {"interfaces/", "sim/model/skeleton/"}},
    {"sim/control/", {"interfaces/", "firmware/core/", "sim/model/"}},
    {"sim/formats/", {"interfaces/", "sim/model/"}},
    {"sim/world/", {"interfaces/", "firmware/", "sim/model/", "sim/control/"}},

    // Learning: its laws serve components and training; training alone has the simulated world.
    {"sim/learning/training_loop/", {"interfaces/"}},
    {"sim/learning/muscle_networks/", {"interfaces/", "sim/model/", "sim/control/"}},
    {"sim/learning/calibration/",
     {"interfaces/", "sim/model/", "sim/control/", "sim/learning/training_loop/"}},
    {"sim/learning/sensorimotor/", {"interfaces/", "sim/model/", "sim/learning/training_loop/"}},
    {"sim/learning/experience/", {"interfaces/", "sim/model/", "sim/control/"}},
    {"sim/learning/synergy/", {"interfaces/", "sim/model/", "sim/learning/training_loop/"}},
    {"sim/learning/simulated_training/",
     {"interfaces/", "sim/model/", "sim/control/", "sim/world/", "sim/learning/"}},

    // The gap between a robot and its model: from what a recording leaves of the laws up.
    {"sim/gap/residuals/", {"interfaces/", "firmware/core/", "sim/model/"}},
    {"sim/gap/checks/", {"interfaces/", "sim/model/", "sim/gap/residuals/"}},
    {"sim/gap/estimation/", {"interfaces/", "sim/model/", "sim/gap/residuals/"}},
    {"sim/gap/diagnosis/",
     {"interfaces/", "firmware/core/", "sim/model/", "sim/control/", "sim/gap/residuals/",
      "sim/gap/estimation/"}},
    // A robot of a physics of its own: of the model it knows bones and paths, no effects.
    {"sim/gap/blind/",
     {"interfaces/", "firmware/core/", "sim/model/skeleton/", "sim/model/actuator/",
      "sim/control/"}},
    {"sim/gap/closed_loop/",
     {"interfaces/", "sim/model/", "sim/control/", "sim/world/", "sim/gap/residuals/",
      "sim/gap/diagnosis/"}},

    {"components/node/", {"interfaces/"}},
    {"components/joints/", {"interfaces/", "sim/model/"}},
    {"components/images/", {"interfaces/", "components/node/", "components/joints/", "sim/model/"}},
    {"components/follow/",
     {"interfaces/", "components/node/", "firmware/core/", "sim/model/", "sim/control/"}},
    {"components/",
     {"interfaces/", "components/node/", "components/joints/", "components/images/",
      "components/follow/", "firmware/core/", "sim/model/", "sim/control/",
      "sim/learning/training_loop/", "sim/learning/muscle_networks/", "sim/learning/sensorimotor/",
      "sim/learning/experience/", "sim/learning/synergy/"}},
    {"components/gap_monitor/",
     {"interfaces/", "components/node/", "sim/model/", "sim/gap/residuals/", "sim/gap/diagnosis/"}},
    {"components/gateway/", {"interfaces/", "components/node/", "firmware/core/", "hal/can/"}},
    {"components/sim/",
     {"interfaces/", "components/node/", "firmware/", "hal/can/", "sim/model/", "sim/world/"}},

    // The command line: a folder a family of verbs.
    {"launch/erp/text/", {"interfaces/"}},
    {"launch/erp/verbs/", {"interfaces/", "components/node/", "launch/erp/text/"}},
    {"launch/erp/record/", {"interfaces/", "launch/erp/text/", "launch/erp/verbs/", "sim/model/"}},
    {"launch/erp/run/",
     {"interfaces/", "components/node/", "hal/can/", "launch/erp/text/", "launch/erp/verbs/",
      "launch/erp/record/"}},
    {"launch/erp/model/",
     {"interfaces/", "launch/erp/text/", "launch/erp/verbs/", "sim/model/", "sim/control/",
      "sim/formats/", "sim/learning/muscle_networks/"}},
    {"launch/erp/security/", {"interfaces/", "components/node/", "launch/erp/verbs/"}},
    {"launch/erp/new/", {"interfaces/", "components/node/", "launch/erp/verbs/"}},
    {"launch/erp/learn/",
     {"interfaces/", "launch/erp/text/", "launch/erp/verbs/", "launch/erp/run/", "sim/model/",
      "sim/control/", "sim/learning/", "sim/gap/closed_loop/"}},
    {"launch/erp/gap/",
     {"interfaces/", "launch/erp/text/", "launch/erp/verbs/", "launch/erp/run/", "sim/model/",
      "sim/formats/", "sim/control/", "sim/gap/"}},
    {"launch/erp/inspect/",
     {"interfaces/", "components/node/", "hal/can/", "launch/erp/text/", "launch/erp/verbs/",
      "launch/erp/run/", "launch/erp/gap/", "sim/model/", "sim/control/", "sim/learning/"}},
    {"launch/erp/", {"interfaces/", "launch/erp/"}},
};

// Headers of others that have one home.
const std::vector<Rule> homes{
    {"dds/", {"components/node/"}},      {"bt", {"sim/world/"}},
    {"Bullet", {"sim/world/"}},          {"linux/can", {"hal/can/"}},
    {"Eigen/", {"sim/", "components/"}}, {"tinyxml2.h", {"interfaces/xml/"}},
};

bool starts(const std::string& text, const std::string& with) { return text.rfind(with, 0) == 0; }

bool starts_any(const std::string& text, const std::vector<std::string>& with) {
  return std::any_of(with.begin(), with.end(), [&](const auto& w) { return starts(text, w); });
}

const Rule* rule_for(const std::string& file) {
  const Rule* best = nullptr;
  for (const auto& rule : rules)
    if (starts(file, rule.room) && (!best || rule.room.size() > best->room.size())) best = &rule;
  return best;
}

/// What counts as "itself": the room of the rule, or the folder below it where that is a room.
std::string home_of(const std::string& file, const Rule* rule) {
  const auto second = file.find('/', file.find('/') + 1);
  const std::string folder = file.substr(0, second + 1);
  return rule && rule->room.size() > folder.size() ? rule->room : folder;
}

std::vector<std::string> violations(const std::string& file, std::istream& text) {
  static const std::regex include(R"(^\s*#\s*include\s*[<"]([^">]+)[">])");
  std::vector<std::string> found;
  const Rule* rule = rule_for(file);
  std::smatch match;
  for (std::string line; std::getline(text, line);) {
    if (!std::regex_search(line, match, include)) continue;
    const std::string header = match[1];
    for (const auto& home : homes)
      if (starts(header, home.room) && !starts_any(file, home.may_include))
        found.push_back(file + " includes " + header);
    const bool ours = starts_any(
        header, {"interfaces/", "components/", "sim/", "hal/", "firmware/", "launch/", "tests/"});
    if (rule && ours && !starts(header, home_of(file, rule)) &&
        !starts_any(header, rule->may_include))
      found.push_back(file + " includes " + header);
  }
  return found;
}

bool is_source(const fs::path& path) {
  const auto ending = path.extension().string();
  return ending == ".hpp" || ending == ".cpp" || ending == ".h" || ending == ".c";
}

}  // namespace

TEST_CASE("every room includes only what it may") {
  std::size_t files = 0;
  for (const auto* top : {"interfaces", "components", "sim", "hal", "firmware", "launch"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(ERP_SOURCE_DIR) / top)) {
      if (!is_source(entry.path())) continue;
      ++files;
      std::ifstream text(entry.path());
      const auto name = fs::relative(entry.path(), ERP_SOURCE_DIR).string();
      for (const auto& violation : violations(name, text)) FAIL_CHECK(violation);
    }
  CHECK(files > 100);
}

TEST_CASE("no room may include one that stands below it in the table") {
  for (std::size_t r = 0; r < rules.size(); ++r)
    for (const auto& allowed : rules[r].may_include)
      for (std::size_t other = r + 1; other < rules.size(); ++other) {
        INFO(rules[r].room << " may include " << allowed);
        CHECK(!starts(rules[other].room, allowed));
      }
}

TEST_CASE("a forbidden include is found") {
  std::istringstream bad("#include <dds/dds.h>\n#include \"sim/world/world.hpp\"\n");
  CHECK(violations("components/plant/x.cpp", bad).size() == 2);
  std::istringstream good("#include \"interfaces/topics.hpp\"\n#include <vector>\n");
  CHECK(violations("components/plant/x.cpp", good).empty());
}

TEST_CASE("every source folder has a README, its own or that of a folder above") {
  for (const auto* top :
       {"interfaces", "components", "sim", "hal", "firmware", "launch", "configs", "tests"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(ERP_SOURCE_DIR) / top)) {
      if (!is_source(entry.path())) continue;
      auto folder = entry.path().parent_path();
      INFO(entry.path());
      bool found = false;  // its own, or that of the room it belongs to
      for (; !found && folder != fs::path(ERP_SOURCE_DIR); folder = folder.parent_path())
        found = fs::exists(folder / "README.md");
      CHECK(found);
    }
}
