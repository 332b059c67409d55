// Checks which folders each folder includes. The table below has the rules. The test reads every
// #include of the source tree.
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
  std::string folder;
  std::vector<std::string> may_include;  ///< in addition to `folder`
};

// A folder includes only folders of rows above its own row. The rule of a file is the one with the
// longest matching folder. Folders of components/ that have no rule of their own follow the rule of
// components/, and do not include each other.
const std::vector<Rule> rules{
    {"interfaces/", {"interfaces/"}},
    {"firmware/core/", {}},
    {"firmware/board/", {"firmware/core/"}},
    {"hal/can/", {"interfaces/", "firmware/core/"}},
    {"hal/ecu/", {"interfaces/", "hal/can/", "firmware/"}},

    // Laws of a robot, and the computations of controllers from these laws. They use no physics
    // engine, bus or clock.
    {"sim/model/effects/", {"interfaces/"}},
    {"sim/model/skeleton/", {"interfaces/"}},
    {"sim/model/actuator/",
     {"interfaces/", "firmware/core/", "sim/model/effects/", "sim/model/skeleton/"}},
    {"sim/model/cameras/", {"interfaces/", "sim/model/skeleton/"}},
    {"sim/control/", {"interfaces/", "firmware/core/", "sim/model/"}},
    {"sim/formats/", {"interfaces/", "sim/model/"}},
    {"sim/world/", {"interfaces/", "firmware/", "sim/model/", "sim/control/"}},

    // Learning. Components and training use its laws. Only training uses the simulated world.
    {"sim/learning/training_loop/", {"interfaces/"}},
    {"sim/learning/muscle_networks/", {"interfaces/", "sim/model/", "sim/control/"}},
    {"sim/learning/calibration/",
     {"interfaces/", "sim/model/", "sim/control/", "sim/learning/training_loop/"}},
    {"sim/learning/sensorimotor/", {"interfaces/", "sim/model/", "sim/learning/training_loop/"}},
    {"sim/learning/experience/", {"interfaces/", "sim/model/", "sim/control/"}},
    {"sim/learning/synergy/", {"interfaces/", "sim/model/", "sim/learning/training_loop/"}},
    {"sim/learning/simulated_training/",
     {"interfaces/", "sim/model/", "sim/control/", "sim/world/", "sim/learning/"}},

    // The gap between a robot and its model, beginning with the residuals of a recording.
    {"sim/gap/residuals/", {"interfaces/", "firmware/core/", "sim/model/"}},
    {"sim/gap/checks/", {"interfaces/", "sim/model/", "sim/gap/residuals/"}},
    {"sim/gap/estimation/", {"interfaces/", "sim/model/", "sim/gap/residuals/"}},
    {"sim/gap/diagnosis/",
     {"interfaces/", "firmware/core/", "sim/model/", "sim/control/", "sim/gap/residuals/",
      "sim/gap/estimation/"}},
    // A simulated robot with its own physics. It uses bones and paths of the model, but no effects.
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

    // The command line. Each folder has one group of verbs.
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
    {"launch/erp/command/",
     {"interfaces/", "components/node/", "launch/erp/text/", "launch/erp/verbs/",
      "launch/erp/inspect/", "sim/world/"}},
    {"launch/erp/", {"interfaces/", "launch/erp/"}},
};

// Headers of external libraries, and the only folders that may include them.
const std::vector<Rule> library_rules{
    {"dds/", {"components/node/"}},      {"bt", {"sim/world/"}},
    {"Bullet", {"sim/world/"}},          {"linux/can", {"hal/can/"}},
    {"Eigen/", {"sim/", "components/"}}, {"tinyxml2.h", {"interfaces/xml/"}},
};

bool starts_with(const std::string& text, const std::string& prefix) {
  return text.rfind(prefix, 0) == 0;
}

bool starts_with_any(const std::string& text, const std::vector<std::string>& prefixes) {
  return std::any_of(prefixes.begin(), prefixes.end(),
                     [&](const auto& prefix) { return starts_with(text, prefix); });
}

const Rule* rule_for(const std::string& file) {
  const Rule* longest_match = nullptr;
  for (const auto& rule : rules)
    if (starts_with(file, rule.folder) &&
        (!longest_match || rule.folder.size() > longest_match->folder.size()))
      longest_match = &rule;
  return longest_match;
}

/// Returns the folder that a file may always include: the folder of its rule, or the folder of the
/// first two levels of its path if that is longer.
std::string own_folder(const std::string& file, const Rule* rule) {
  const auto second_slash = file.find('/', file.find('/') + 1);
  const std::string two_levels = file.substr(0, second_slash + 1);
  return rule && rule->folder.size() > two_levels.size() ? rule->folder : two_levels;
}

std::vector<std::string> violations_of(const std::string& file, std::istream& text) {
  static const std::regex include(R"(^\s*#\s*include\s*[<"]([^">]+)[">])");
  std::vector<std::string> violations;
  const Rule* rule = rule_for(file);
  std::smatch match;
  for (std::string line; std::getline(text, line);) {
    if (!std::regex_search(line, match, include)) continue;
    const std::string header = match[1];
    for (const auto& library : library_rules)
      if (starts_with(header, library.folder) && !starts_with_any(file, library.may_include))
        violations.push_back(file + " includes " + header);
    const bool is_of_project = starts_with_any(
        header, {"interfaces/", "components/", "sim/", "hal/", "firmware/", "launch/", "tests/"});
    if (rule && is_of_project && !starts_with(header, own_folder(file, rule)) &&
        !starts_with_any(header, rule->may_include))
      violations.push_back(file + " includes " + header);
  }
  return violations;
}

bool is_source(const fs::path& path) {
  const auto ending = path.extension().string();
  return ending == ".hpp" || ending == ".cpp" || ending == ".h" || ending == ".c";
}

}  // namespace

TEST_CASE("every folder includes only the folders that its rule permits") {
  std::size_t files = 0;
  for (const auto* top : {"interfaces", "components", "sim", "hal", "firmware", "launch"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(ERP_SOURCE_DIR) / top)) {
      if (!is_source(entry.path())) continue;
      ++files;
      std::ifstream text(entry.path());
      const auto name = fs::relative(entry.path(), ERP_SOURCE_DIR).string();
      for (const auto& violation : violations_of(name, text)) FAIL_CHECK(violation);
    }
  CHECK(files > 100);  // chosen: the search found the source tree
}

TEST_CASE("no rule permits a folder of a later row") {
  for (std::size_t row = 0; row < rules.size(); ++row)
    for (const auto& allowed : rules[row].may_include)
      for (std::size_t later = row + 1; later < rules.size(); ++later) {
        INFO(rules[row].folder << " may include " << allowed);
        CHECK(!starts_with(rules[later].folder, allowed));
      }
}

TEST_CASE("forbidden includes are reported, permitted ones are not") {
  std::istringstream forbidden("#include <dds/dds.h>\n#include \"sim/world/world.hpp\"\n");
  CHECK(violations_of("components/plant/x.cpp", forbidden).size() == 2);
  std::istringstream permitted("#include \"interfaces/topics.hpp\"\n#include <vector>\n");
  CHECK(violations_of("components/plant/x.cpp", permitted).empty());
}

TEST_CASE("every source folder or one of its parent folders has a README") {
  for (const auto* top :
       {"interfaces", "components", "sim", "hal", "firmware", "launch", "configs", "tests"})
    for (const auto& entry : fs::recursive_directory_iterator(fs::path(ERP_SOURCE_DIR) / top)) {
      if (!is_source(entry.path())) continue;
      auto folder = entry.path().parent_path();
      INFO(entry.path());
      bool has_readme = false;
      for (; !has_readme && folder != fs::path(ERP_SOURCE_DIR); folder = folder.parent_path())
        has_readme = fs::exists(folder / "README.md");
      CHECK(has_readme);
    }
}
