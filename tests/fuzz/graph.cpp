// Target: arbitrary text as a launch graph. Its folder has a robot, a target and a recording that
// the graph may name.
#include "interfaces/graph/graph.hpp"

#include "interfaces/xml/errors.hpp"
#include "tests/fuzz/input.hpp"

namespace {

fuzz::Folder make_folder() {
  const fuzz::Folder folder;
  folder.write("robot.xml", "<robot name=\"rig\"/>");
  folder.write("target.xml", "<target/>");
  folder.write("run.mcap", "");
  return folder;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::Folder folder = make_folder();
  try {
    const erp::Graph graph = erp::read_graph(folder.write("graph.xml", data, size));
    fuzz::require(std::filesystem::is_regular_file(graph.robot), "the robot of a graph is a file");
  } catch (const xml::Errors&) {
  }
  return 0;
}
