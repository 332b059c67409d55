#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>

#include "interfaces/graph/graph.hpp"
#include "interfaces/robot/robot.hpp"
#include "interfaces/xml/xml.hpp"
#include "launch/erp/inspect/check.hpp"
#include "tests/interfaces/xml/example.hpp"
#include "tests/interfaces/xml/xmllint.hpp"

namespace fs = std::filesystem;

namespace {

const fs::path folder = fs::path(ERP_SOURCE_DIR) / "tests/interfaces/broken";

/// The expected error, from the first line of a file: `<!-- expect [semantic] LINE:COLUMN MESSAGE
/// -->`.
struct Expected {
  bool semantic = false;
  std::string place, message;
};

Expected expected_of(const fs::path& file) {
  std::ifstream in(file);
  std::string line, kind;
  std::getline(in, line);
  REQUIRE(line.starts_with("<!-- expect "));
  std::istringstream rest(line.substr(12, line.size() - 12 - 4));
  Expected expected;
  rest >> expected.place;
  if ((expected.semantic = expected.place == "semantic")) rest >> expected.place;
  std::getline(rest >> std::ws, expected.message);
  return expected;
}

std::vector<std::string> files_in(const std::string& kind) {
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(folder / kind))
    if (entry.path().extension() == ".xml") files.push_back(entry.path().string());
  return files;
}

std::string place_text(const xml::Place& place) {
  return std::to_string(place.line) + ":" + std::to_string(place.column);
}

using Read = std::function<void(const std::string& file)>;

void read_tracker(const std::string& file) {
  example::Params params;
  xml::read_into(params, file, "tracker");
}

/// Checks that the file has exactly one error, with the expected place and message.
void check_rejected(const Read& read, const std::string& file, const Expected& expected) {
  INFO(file);
  try {
    read(file);
    FAIL_CHECK("was accepted");
  } catch (const xml::Errors& errors) {
    INFO(errors.what());
    CHECK(errors.all().size() == 1);
    CHECK(place_text(errors.all().front().place) == expected.place);
    CHECK_THAT(to_string(errors.all().front()), Catch::Contains(expected.message));
    CHECK_FALSE(errors.all().front().remedy.empty());
  }
}

void check_kind(const std::string& kind, const std::string& schema, const Read& read) {
  const auto files = files_in(kind);
  const auto valid = valid_by_schema(schema, files);
  for (const std::string& file : files) {
    const Expected expected = expected_of(file);
    check_rejected(read, file, expected);
    INFO(file);
    CHECK(valid.contains(file) == expected.semantic);
  }
}

std::string schema_file(const std::string& kind) {
  return std::string(ERP_SOURCE_DIR) + "/interfaces/schema/" + kind + ".xsd";
}

}  // namespace

TEST_CASE(
    "every broken robot is rejected with the place of its error; the XSD rejects structural "
    "errors") {
  check_kind("robot", schema_file("robot"), [](const auto& file) { erp::read_robot(file); });
}

TEST_CASE(
    "every broken graph is rejected with the place of its error; the XSD rejects structural "
    "errors") {
  check_kind("graph", schema_file("graph"), [](const auto& file) { erp::read_graph(file); });
}

TEST_CASE("every broken component config is rejected with the place of its error, and by its XSD") {
  const std::string schema = temporary("tracker.xsd", xml::schema<example::Params>("tracker"));
  check_kind("component", schema, read_tracker);
  fs::remove(schema);
}

TEST_CASE("the files from which the broken files were made are valid") {
  CHECK_NOTHROW(erp::read_robot((folder / "good/robot.xml").string()));
  CHECK_NOTHROW(erp::read_graph((folder / "good/graph.xml").string()));
  CHECK_NOTHROW(read_tracker((folder / "good/tracker.xml").string()));
}

TEST_CASE("erp check prints every error and exits with 2, or prints ok and exits with 0") {
  const launch::CheckComponent check_trackers =
      [](const std::string& type, const std::string& file) -> std::optional<std::string> {
    if (type != "tracker") return std::nullopt;
    return example::refusal([&] { read_tracker(file); });
  };
  const auto check = [&](const fs::path& file, std::string& printed) {
    std::ostringstream out;
    const int code = launch::check({file.string()}, out, check_trackers);
    printed = out.str();
    return code;
  };
  std::string printed;
  CHECK(check(folder / "good/graph.xml", printed) == 0);
  CHECK_THAT(printed, Catch::Contains("good/graph.xml: ok\n") &&
                          Catch::Contains("robot.xml: ok\n") &&
                          Catch::Contains("tracker.xml: ok\n"));
  for (const char* kind : {"robot", "graph", "component"})
    for (const std::string& file : files_in(kind)) {
      INFO(file);
      CHECK(check(file, printed) == 2);
      CHECK_THAT(printed, Catch::Contains(": ") && !Catch::Contains("ok\n"));
    }
  CHECK(check("none.xml", printed) == 2);
}

TEST_CASE("the program of a component checks its config") {
  const auto output_of = [](const std::string& script) {
    const std::string program = temporary("component.sh", "#!/bin/sh\n" + script + "\n");
    fs::permissions(program, fs::perms::owner_all);
    const auto check = launch::check_by_program(
        [&](const std::string& type) { return type == "tracker" ? program : ""; });
    const auto errors = check("tracker", "f.xml");
    CHECK_FALSE(check("other", "f.xml").has_value());
    fs::remove(program);
    return errors.value();
  };
  CHECK(output_of("exit 0").empty());
  CHECK(output_of("echo \"$2:1:1: $3\" >&2; exit 2") == "f.xml:1:1: --check\n");
  CHECK_THAT(output_of("exit 1"), Catch::Contains("failed without a message"));
}
