// Checks README.md: its controller equals the template of `erp new controller`, and the files that
// it names exist.
#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>

namespace {

std::string content(const std::string& file) {
  std::ifstream in(std::string(ERP_SOURCE_DIR "/") + file);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

std::string replace_placeholders(std::string text) {
  text = std::regex_replace(text, std::regex("@Class@"), "MyController");
  return std::regex_replace(text, std::regex("@name@"), "my_controller");
}

}  // namespace

TEST_CASE("the controller in README.md equals the one that erp new controller writes") {
  const auto readme = content("README.md");
  CHECK(readme.find(replace_placeholders(
            content("launch/erp/new/templates/controller/controller.hpp"))) != std::string::npos);
  CHECK(readme.find(replace_placeholders(
            content("launch/erp/new/templates/controller/main.cpp"))) != std::string::npos);
}

TEST_CASE("every file that README.md names exists") {
  const auto readme = content("README.md");
  const std::regex path(
      R"((launch|configs|tests|components|interfaces|sim|hal|firmware)/[a-z_0-9/.]+\.(xml|sh|png|md|hpp))");
  int count = 0;
  for (std::sregex_iterator it(readme.begin(), readme.end(), path), end; it != end; ++it, ++count) {
    INFO(it->str());
    CHECK(std::filesystem::exists(std::string(ERP_SOURCE_DIR "/") + it->str()));
  }
  CHECK(count > 5);  // chosen: the expression finds paths
}
