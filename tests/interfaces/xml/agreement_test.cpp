#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "interfaces/graph/graph.hpp"
#include "interfaces/robot/robot.hpp"
#include "interfaces/xml/xml.hpp"
#include "launch/erp/inspect/check.hpp"
#include "tests/interfaces/xml/xmllint.hpp"

namespace fs = std::filesystem;

namespace {

const fs::path source_folder = ERP_SOURCE_DIR;

std::string contents(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

std::string generated(const std::string& kind) {
  std::ostringstream text;
  launch::print_schema(kind, text);
  return text.str();
}

void add_if(std::vector<std::string>& files, const fs::path& file, const std::string& kind) {
  if (file.extension() == ".xml" && xml::read_document(file.string()).name == kind)
    files.push_back(file.string());
}

/// Every XML file in configs/ and in launch/ (without subfolders) with the root element `kind`.
std::vector<std::string> files_of(const std::string& kind) {
  std::vector<std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(source_folder / "configs"))
    add_if(files, entry.path(), kind);
  for (const auto& entry : fs::directory_iterator(source_folder / "launch"))
    add_if(files, entry.path(), kind);
  return files;
}

/// Checks only the structure, because a part of a robot may refer to bodies of another part.
template <class T>
void check_agreement(const std::string& kind) {
  const auto files = files_of(kind);
  REQUIRE_FALSE(files.empty());
  const auto valid =
      valid_by_schema((source_folder / "interfaces/schema" / (kind + ".xsd")).string(), files);
  for (const std::string& file : files) {
    INFO(file);
    CHECK_NOTHROW(xml::read<T>(file));
    CHECK(valid.contains(file));
  }
}

}  // namespace

TEST_CASE("the committed XSDs equal those generated from the structs") {
  // To regenerate an XSD: erp check --schema robot > interfaces/schema/robot.xsd
  CHECK(contents(source_folder / "interfaces/schema/robot.xsd") == generated("robot"));
  CHECK(contents(source_folder / "interfaces/schema/graph.xsd") == generated("graph"));
}

TEST_CASE("reader and XSD both accept every robot in configs and launch") {
  check_agreement<erp::Robot>("robot");
}

TEST_CASE("reader and XSD both accept every graph in configs and launch") {
  check_agreement<erp::Graph>("graph");
}

TEST_CASE("every robot.xml in configs is valid") {
  for (const std::string& file : files_of("robot"))
    if (fs::path(file).filename() == "robot.xml") {
      INFO(file);
      CHECK_NOTHROW(erp::read_robot(file));
    }
}
