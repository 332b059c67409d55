#include "interfaces/graph/graph.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "tests/interfaces/xml/example.hpp"

namespace fs = std::filesystem;

namespace {

const fs::path broken_files = fs::path(ERP_SOURCE_DIR) / "tests/interfaces/broken";

/// Reads a graph from a folder that contains the valid robot.xml and tracker.xml.
erp::Graph read(const std::string& text) {
  const fs::path folder = fs::temp_directory_path() / ("erp_graph_" + std::to_string(getpid()));
  fs::create_directories(folder / "launch");
  for (const char* name : {"robot.xml", "tracker.xml"})
    fs::copy_file(broken_files / "good" / name, folder / name,
                  fs::copy_options::overwrite_existing);
  std::ofstream(folder / "log.mcap").close();
  std::ofstream(folder / "launch/graph.xml") << text;
  struct Remove {
    fs::path folder;
    ~Remove() { fs::remove_all(folder); }
  } const remove{folder};
  return erp::read_graph((folder / "launch/graph.xml").string());
}

}  // namespace

TEST_CASE("file names of a graph are resolved relative to its folder") {
  const auto graph = read(
      "<graph name='g' robot='../robot.xml' device='replay' replay='../log.mcap'>"
      "<component name='t1' type='tracker' config='../tracker.xml'/></graph>");
  CHECK(fs::path(graph.robot).is_absolute());
  CHECK(fs::path(graph.robot).filename() == "robot.xml");
  CHECK(graph.robot.find("..") == std::string::npos);
  CHECK(fs::path(graph.replay).filename() == "log.mcap");
  CHECK(fs::path(graph.components[0].config).parent_path() == fs::path(graph.robot).parent_path());
}

TEST_CASE("attributes absent from a graph have their defaults") {
  const auto graph = read("<graph name='g' robot='../robot.xml'><component name='c'/></graph>");
  CHECK(graph.device == erp::Device::sim);
  CHECK(graph.time == erp::Time::realtime);
  CHECK(graph.components[0].restart == erp::Restart::on_failure);
  CHECK(graph.components[0].config.empty());
}

TEST_CASE("a component's type may be a path; the root element of its config is the file name") {
  CHECK(read("<graph name='g' robot='../robot.xml'>"
             "<component name='mine' type='../build/tracker' config='../tracker.xml'/></graph>")
            .components.size() == 1);
}

TEST_CASE("a missing replay file is accepted while another device is selected") {
  CHECK(read("<graph name='g' robot='../robot.xml' device='sim' replay='missing.mcap'/>").device ==
        erp::Device::sim);
}

TEST_CASE("all errors of a graph are reported at once") {
  const std::string error_text = example::refusal([] {
    read(
        "<graph name='g' robot='none.xml' device='replay'>"
        "<component name='a' config='none.xml'/><component name='a'/></graph>");
  });
  CHECK_THAT(error_text, Catch::Contains("robot=\"none.xml\" is not a file"));
  CHECK_THAT(error_text, Catch::Contains("has no recording"));
  CHECK_THAT(error_text, Catch::Contains("config=\"none.xml\" is not a file"));
  CHECK_THAT(error_text, Catch::Contains("duplicate name \"a\""));
}

TEST_CASE("a config that is not well-formed XML is reported with its file, line and column") {
  const std::string error_text = example::refusal([] {
    read(
        "<graph name='g' robot='graph.xml'><component name='c' "
        "config='graph.xml'/>\n<open></graph>");
  });
  CHECK_THAT(error_text, Catch::Contains("graph.xml:2:7: </graph> where <open> is open"));
}
