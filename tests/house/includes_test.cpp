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

// The longest matching room decides.
const std::vector<Rule> rules{
    {"interfaces/", {}},
    {"firmware/core/", {}},
    // What runs a firmware on this machine: a program of the host, on the host's buses.
    {"firmware/board/host/", {"interfaces/", "hal/can/", "firmware/"}},
    {"firmware/board/", {"firmware/core/"}},
    {"components/node/", {"interfaces/"}},
    {"components/follow/", {"interfaces/", "components/node/", "firmware/core/", "sim/actuator/"}},
    {"components/length_control/",
     {"interfaces/", "components/node/", "components/follow/", "firmware/core/"}},
    {"components/force_control/",
     {"interfaces/", "components/node/", "components/follow/", "firmware/core/"}},
    {"components/joints/", {"interfaces/", "sim/skeleton/"}},
    {"components/images/",
     {"interfaces/", "components/node/", "components/joints/", "sim/cameras/", "sim/skeleton/"}},
    {"components/gap_monitor/",
     {"interfaces/", "components/node/", "sim/diagnosis/", "sim/residuals/", "sim/effects/"}},
    {"components/",
     {"interfaces/", "components/node/", "components/images/", "components/joints/",
      "firmware/core/", "sim/actuator/", "sim/cameras/", "sim/learning/", "sim/loop_shaping/",
      "sim/experience/", "sim/learner/", "sim/sensorimotor/", "sim/skeleton/", "sim/synergy/"}},
    {"sim/cameras/", {"interfaces/", "sim/skeleton/"}},
    {"sim/learning/", {"interfaces/", "sim/actuator/", "sim/skeleton/"}},
    {"sim/parallel/", {}},
    {"sim/learner/", {"interfaces/", "sim/parallel/"}},
    {"sim/calibration/",
     {"interfaces/", "sim/actuator/", "sim/effects/", "sim/learner/", "sim/parallel/",
      "sim/skeleton/"}},
    {"sim/sensorimotor/", {"interfaces/", "sim/cameras/", "sim/learner/", "sim/skeleton/"}},
    {"sim/experience/", {"interfaces/", "sim/actuator/", "sim/skeleton/"}},
    {"sim/synergy/", {"interfaces/", "sim/learner/", "sim/skeleton/"}},
    {"sim/lessons/", {"interfaces/", "sim/"}},
    {"sim/loop_shaping/", {"interfaces/", "sim/actuator/", "sim/skeleton/"}},
    {"sim/actuator/", {"interfaces/", "firmware/core/", "sim/effects/", "sim/skeleton/"}},
    {"sim/residuals/",
     {"interfaces/", "firmware/core/", "sim/effects/", "sim/actuator/", "sim/skeleton/"}},
    {"sim/gap/",
     {"interfaces/", "sim/residuals/", "sim/effects/", "sim/actuator/", "sim/parallel/"}},
    {"sim/soundness/", {"interfaces/", "sim/residuals/", "sim/actuator/"}},
    {"sim/diagnosis/",
     {"interfaces/", "firmware/core/", "sim/residuals/", "sim/effects/", "sim/actuator/",
      "sim/gap/", "sim/parallel/"}},
    // A robot of a physics of its own: of the simulator it may know bones and paths, no effects.
    {"sim/blind/", {"interfaces/", "firmware/core/", "sim/actuator/", "sim/skeleton/"}},
    {"sim/effects/", {"interfaces/"}},
    {"sim/skeleton/", {"interfaces/"}},
    {"sim/formats/", {"interfaces/", "sim/skeleton/", "sim/actuator/"}},
    {"sim/world/", {"interfaces/", "components/node/", "firmware/", "sim/", "hal/can/"}},
    {"sim/rehearsal/", {"interfaces/", "sim/"}},
    {"hal/", {"interfaces/", "components/node/", "firmware/core/"}},
    {"launch/text/", {"interfaces/"}},
    {"launch/learn/",
     {"interfaces/", "launch/text/", "sim/actuator/", "sim/calibration/", "sim/cameras/",
      "sim/experience/", "sim/learner/", "sim/lessons/", "sim/parallel/", "sim/sensorimotor/",
      "sim/rehearsal/", "sim/skeleton/", "sim/synergy/"}},
    {"launch/gap/",
     {"interfaces/", "launch/text/", "sim/formats/", "sim/blind/", "sim/diagnosis/",
      "sim/gap/", "sim/parallel/", "sim/rehearsal/", "sim/residuals/", "sim/soundness/", "sim/effects/"}},
    {"launch/erp/",
     {"interfaces/", "components/node/", "launch/text/", "launch/gap/", "launch/learn/",
      "sim/calibration/", "sim/cameras/", "sim/experience/", "sim/sensorimotor/", "sim/synergy/",
      "hal/can/", "sim/formats/", "sim/effects/", "sim/actuator/", "sim/learning/",
      "sim/loop_shaping/", "sim/skeleton/"}},
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

/// The first folder component, or two for components, sim and launch: what counts as "itself".
std::string home_of(const std::string& file) {
  const auto slash = file.find('/');
  const auto second = file.find('/', slash + 1);
  const auto top = file.substr(0, slash + 1);
  const bool of_rooms = top == "components/" || top == "sim/" || top == "launch/";
  return of_rooms ? file.substr(0, second + 1) : top;
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
    if (rule && ours && !starts(header, home_of(file)) && !starts_any(header, rule->may_include))
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

TEST_CASE("a forbidden include is found") {
  std::istringstream bad("#include <dds/dds.h>\n#include \"sim/world/world.hpp\"\n");
  CHECK(violations("components/plant/x.cpp", bad).size() == 2);
  std::istringstream good("#include \"interfaces/topics.hpp\"\n#include <vector>\n");
  CHECK(violations("components/plant/x.cpp", good).empty());
}

TEST_CASE("every folder of the house says in a README what it is") {
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
