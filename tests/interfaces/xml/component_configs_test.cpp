// Configs of components: reader and XSD agree, every parameter has a meaning. One line per
// component.
#include <catch2/catch.hpp>
#include <filesystem>
#include <functional>
#include <map>
#include <sstream>

#include "components/computed_force/computed_force.hpp"
#include "components/experience/experience.hpp"
#include "components/eye/eye.hpp"
#include "components/follow/follow.hpp"
#include "components/gap_monitor/gap_monitor.hpp"
#include "components/gateway/gateway_node.hpp"
#include "components/logger/logger_node.hpp"
#include "components/motion_capture/motion_capture.hpp"
#include "components/plant/plant.hpp"
#include "components/pose_estimator/pose_estimator.hpp"
#include "components/puller_follower/puller_follower.hpp"
#include "components/reference/joint_player.hpp"
#include "components/reference/reference.hpp"
#include "components/replay/replay_node.hpp"
#include "components/sensorimotor/sensorimotor.hpp"
#include "components/sim/sim_node.hpp"
#include "components/synergy/synergy.hpp"
#include "interfaces/xml/xml.hpp"
#include "sim/learning/calibration/parameters.hpp"
#include "sim/learning/experience/task.hpp"
#include "sim/learning/muscle_networks/learned_lengths.hpp"
#include "sim/learning/sensorimotor/learned_map_file.hpp"
#include "sim/learning/synergy/task.hpp"
#include "tests/interfaces/xml/without_description.hpp"
#include "tests/interfaces/xml/xmllint.hpp"

namespace fs = std::filesystem;

namespace {

struct Kind {
  std::function<std::string(const std::string& root)> schema;
  std::function<void(const std::string& file, const std::string& root)> read;
  std::function<std::vector<std::string>(const std::string& root)> without_description;
};

template <class Params>
Kind kind_of() {
  return {[](const std::string& root) { return xml::schema<Params>(root); },
          [](const std::string& file, const std::string& root) {
            Params params;
            xml::read_into(params, file, root);
          },
          [](const std::string& root) { return without_description<Params>(root); }};
}

const std::map<std::string, Kind> kinds{
    {"acquisition", kind_of<sim::experience::Task>()},
    {"calibration", kind_of<sim::calibration::Choice>()},
    {"camera_view", kind_of<sim::cameras::ViewConfig>()},
    {"computed_force", kind_of<control::ComputedForce::Params>()},
    {"experience", kind_of<control::Experience::Params>()},
    {"experience_base", kind_of<sim::experience::BaseFile>()},
    {"eye", kind_of<eye::Eye::Params>()},
    {"force_control", kind_of<follow::Params>()},
    {"gap_monitor", kind_of<GapMonitor::Params>()},
    {"gateway", kind_of<can::GatewayNode::Params>()},
    {"joint_target", kind_of<reference::JointPlayer::Params>()},
    {"length_control", kind_of<follow::Params>()},
    {"loops", kind_of<sim::loop_shaping::JointShape>()},
    {"logger", kind_of<logger::LoggerNode::Params>()},
    {"motion_capture", kind_of<capture::MotionCapture::Params>()},
    {"muscles", kind_of<sim::muscle_networks::LearnedMuscles>()},
    {"plant", kind_of<plant::Plant::Params>()},
    {"pose_estimator", kind_of<pose::PoseEstimator::Params>()},
    {"puller_follower", kind_of<control::PullerFollower::Params>()},
    {"reference", kind_of<reference::Params>()},
    {"replay", kind_of<replay::ReplayNode::Params>()},
    {"sensorimotor", kind_of<control::Sensorimotor::Params>()},
    {"sensorimotor_learnt", kind_of<sim::sensorimotor::LearnedMapFile>()},
    {"sim", kind_of<sim::SimNode::Params>()},
    {"striking", kind_of<sim::synergy::Task>()},
    {"synergy", kind_of<control::Synergy::Params>()},
    {"synergy_bank", kind_of<sim::synergy::BankFile>()},
    {"target", kind_of<reference::Params>()},
};

using Configs = std::map<std::string, std::vector<std::string>>;

/// The configs of components, by root element.
Configs configs_by_root() {
  Configs configs;
  for (const auto& entry : fs::recursive_directory_iterator(fs::path(ERP_SOURCE_DIR) / "configs")) {
    if (entry.path().extension() != ".xml") continue;
    const std::string root = xml::read_document(entry.path().string()).name;
    if (root != "robot" && root != "graph") configs[root].push_back(entry.path().string());
  }
  return configs;
}

}  // namespace

TEST_CASE(
    "every parameter of every component, and of every file that a config names, has a meaning") {
  for (const auto& [root, kind] : kinds)
    CHECK(kind.without_description(root) == std::vector<std::string>{});
}

TEST_CASE("the list above has every component that is installed") {
  std::istringstream components(ERP_COMPONENTS);
  int count = 0;
  for (std::string name; components >> name; ++count) {
    INFO(name);
    CHECK(kinds.contains(name));
  }
  CHECK(count > 15);
}

TEST_CASE("reader and XSD both accept every component's config") {
  const Configs configs = configs_by_root();
  REQUIRE_FALSE(configs.empty());
  for (const auto& [root, files] : configs) {
    INFO("<" << root << "> is missing in the list above");
    REQUIRE(kinds.contains(root));
    const std::string schema = temporary(root + ".xsd", kinds.at(root).schema(root));
    const auto valid = valid_by_schema(schema, files);
    for (const std::string& file : files) {
      INFO(file);
      CHECK_NOTHROW(kinds.at(root).read(file, root));
      CHECK(valid.contains(file));
    }
    fs::remove(schema);
  }
}

TEST_CASE("reader and XSD of every component refuse an unknown parameter") {
  for (const auto& [root, kind] : kinds) {
    INFO(root);
    const std::string schema = temporary(root + ".xsd", kind.schema(root));
    const std::string file = temporary(root + ".xml", "<" + root + " unknown_parameter=\"1\"/>");
    CHECK(valid_by_schema(schema, {file}).empty());
    CHECK_THROWS_AS(kind.read(file, root), xml::Errors);
    fs::remove(schema);
    fs::remove(file);
  }
}
