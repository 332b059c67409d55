// The help of erp: erp help, the manual page, the completion of bash.
#include <catch2/catch.hpp>
#include <regex>

#include "tests/system/command.hpp"

using namespace tests;
using Catch::Matchers::Contains;

namespace {

/// The verbs that a help text lists, beginning at `heading`.
std::vector<std::string> verbs_in(const std::string& help, const std::string& heading) {
  std::vector<std::string> verbs;
  const auto begin = help.find(heading);
  if (begin == help.npos) return verbs;
  const std::string rest = help.substr(begin);
  const std::regex line(R"(\n  ([a-z]+) {2,}[A-Z])");
  for (std::sregex_iterator it(rest.begin(), rest.end(), line), end; it != end; ++it)
    verbs.push_back((*it)[1]);
  return verbs;
}

/// "erp launch", "erp log info" …, from the help of erp and of each verb.
std::vector<std::string> all_verbs() {
  std::vector<std::string> all;
  for (const auto& verb : verbs_in(run("erp --help").output, "Options:")) {
    const auto inner = verbs_in(run("erp " + verb + " --help").output, "Subcommands:");
    if (inner.empty()) all.push_back("erp " + verb);
    for (const auto& name : inner) all.push_back("erp " + verb + " " + name);
  }
  return all;
}

/// The completions of bash for a command line whose last word is at the cursor.
std::string completions(const std::string& words) {
  return run("bash -c 'source <(erp help --completion bash) && complete -p erp >/dev/null && "
             "COMP_WORDS=(" +
             words +
             ") && COMP_CWORD=$((${#COMP_WORDS[@]} - 1)) && _erp && echo \" ${COMPREPLY[*]} \"'")
      .output;
}

}  // namespace

TEST_CASE(
    "erp help lists formats and components, and explains a component with the description of each "
    "parameter") {
  const auto list = run("erp help");
  CHECK(list.exit_code == 0);
  CHECK_THAT(list.output, Contains("graph robot") && Contains("gap_monitor"));

  const auto component = run("erp help gap_monitor");
  CHECK(component.exit_code == 0);
  CHECK_THAT(component.output, Contains("\nwindow_s  ") &&
                                   Contains("  number from 2 to 60    s  default 4  Length of"));
  const auto by_path = run("erp help " ERP_BIN_DIR "/gap_monitor");
  CHECK(by_path.exit_code == 0);
  CHECK(by_path.output == component.output);
}

TEST_CASE("erp help VERB prints the same as erp VERB --help") {
  CHECK(run("erp help launch").output == run("erp launch --help").output);
}

TEST_CASE(
    "erp help of an unknown name, or of a program that is no component, ends with exit code 2") {
  const auto unknown = run("erp help gap_moniter");
  CHECK(unknown.exit_code == 2);
  CHECK_THAT(unknown.output, Contains("did you mean \"gap_monitor\"?"));
  CHECK(run("erp help sh").exit_code == 2);
  CHECK(run("erp help /bin/false").exit_code == 2);
}

TEST_CASE("the manual page has every verb, and groff formats it without a warning") {
  const Folder folder;
  REQUIRE(run("erp help --man > " + (folder / "erp.1")).exit_code == 0);
  const auto page =
      run("groff -man -ww -Tutf8 -P-cbou " + (folder / "erp.1") + " 2> " + (folder / "warnings"));
  CHECK(page.exit_code == 0);
  CHECK(content(folder / "warnings") == "");
  const auto verbs = all_verbs();
  CHECK(verbs.size() > 30);
  for (const auto& verb : verbs) CHECK_THAT(page.output, Contains("\n   " + verb + " "));
  CHECK_THAT(page.output, Contains("--lockstep") && Contains("EXIT STATUS"));
  CHECK_THAT(page.output, !Contains("gap twins"));  // a former name
}

TEST_CASE("bash completes verbs, verbs of a family, and the options of a verb") {
  CHECK_THAT(completions("erp la"), Contains(" launch "));
  CHECK_THAT(completions("erp log \"\""), Contains(" info ") && Contains(" effort "));
  CHECK_THAT(completions("erp log export --to"), Contains(" --topic "));
  CHECK_THAT(completions("erp gap diagnose --held-out a.mcap --w"), Contains(" --withhold "));
  CHECK_THAT(completions("erp launch confi"), Contains("  "));  // bash completes files
}
