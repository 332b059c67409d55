// A folder of `erp security make`: who is asked to use one either does, or does not run.
#include "launch/erp/security/security.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <regex>

#include "tests/system/command.hpp"

using Catch::Matchers::Contains;
namespace fs = std::filesystem;
using namespace tests;

namespace {

/// A folder of each of two authorities.
struct Two {
  Folder folder;
  fs::path own = folder / "own", other = folder / "other";
  Two() { make(own), make(other); }
  static void make(const fs::path& where) {
    launch::make_security(where, launch::valid_for_days(1));
  }
  void take_from_other(const char* file) const {
    fs::copy_file(other / file, own / file, fs::copy_options::overwrite_existing);
  }
};

Outcome look(const fs::path& security) {
  return run("ERP_SECURITY=" + security.string() + " erp ps");
}

/// A tool, a component and the launcher refuse it alike, saying so.
void check_refused(const fs::path& security, const std::string& place, const std::string& why) {
  const auto with = "ERP_SECURITY=" + security.string() + " ";
  const auto robot = "configs/hinge_rig/robot.xml";
  for (const auto& command :
       {with + "erp ps", with + "'" ERP_TEST_COMPONENTS "/worker' --robot " + robot}) {
    const auto said = run(command);
    INFO(command << '\n' << said.output);
    CHECK(said.exit_code == 2);
    CHECK_THAT(said.output, Contains(place) && Contains(why) && Contains("; "));
  }
}

}  // namespace

TEST_CASE("who has a certificate joins, and its keys are for its owner alone") {
  const Two two;
  const auto said = look(two.own);
  INFO(said.output);
  CHECK(said.exit_code == 0);
  for (const auto* key : {"authority.key", "identity.key"})
    CHECK((fs::status(two.own / key).permissions() & fs::perms::all) ==
          (fs::perms::owner_read | fs::perms::owner_write));
  CHECK((fs::status(two.own).permissions() & fs::perms::all) == fs::perms::owner_all);
}

TEST_CASE("the authority's own key is not needed to join") {
  const Two two;
  fs::remove(two.own / "authority.key");
  CHECK(look(two.own).exit_code == 0);
}

namespace {

/// Security of its own, which nobody could join with.
constexpr auto own_security =
    "<Security><Authentication><Library path=\"none\"/><IdentityCertificate>file:none"
    "</IdentityCertificate><IdentityCA>file:none</IdentityCA><PrivateKey>file:none</PrivateKey>"
    "</Authentication></Security>";

std::string brought(const std::string& file, const std::string& more) {
  std::ofstream(file) << "<CycloneDDS><Domain Id=\"any\"><General><Interfaces><NetworkInterface "
                         "name=\"lo\"/></Interfaces></General>"
                      << more << "</Domain></CycloneDDS>";
  return "CYCLONEDDS_URI=file://" + file + " ";
}

}  // namespace

TEST_CASE("a configuration that a person brings is protected as well, and cannot undo that") {
  const Two two;
  const auto open = brought(two.folder / "open.xml", ""),
             closed = brought(two.folder / "closed.xml", own_security);
  const auto ours = "ERP_SECURITY=" + two.own.string() + " erp ps";
  CHECK(run(open + ours).exit_code == 0);
  CHECK(run(closed + ours).exit_code == 0);
  CHECK(run(closed + "erp ps").exit_code != 0);
  two.take_from_other("permissions.p7s");
  CHECK(run(open + ours).exit_code == 2);
}

TEST_CASE("what is missing is named") {
  const Two two;
  check_refused(two.folder / "none", "none", "no such folder");
  for (const auto* file :
       {"authority.pem", "identity.pem", "identity.key", "governance.p7s", "permissions.p7s"}) {
    const fs::path away = two.folder / "away";
    fs::rename(two.own / file, away);
    check_refused(two.own, file, "is missing");
    fs::rename(away, two.own / file);
  }
  check_refused("", "ERP_SECURITY", "is empty");
}

TEST_CASE("a key that others may use is refused") {
  const Two two;
  const auto key = two.own / "identity.key";
  fs::permissions(key, fs::perms::group_read, fs::perm_options::add);
  check_refused(two.own, "identity.key", "mode 0640; chmod 600");
}

TEST_CASE("a certificate out of its time is refused") {
  const Folder folder;
  const auto now_s = launch::valid_for_days(0).until_s;
  launch::make_security(folder / "old", {now_s - 1000, now_s - 10});
  launch::make_security(folder / "early", {now_s + 1000, now_s + 2000});
  check_refused(folder / "old", "authority.pem", "expired on");
  check_refused(folder / "early", "authority.pem", "is not valid before");
}

TEST_CASE("parts of another authority are refused") {
  const Two two;
  two.take_from_other("identity.key");
  check_refused(two.own, "identity.key", "is not the key of identity.pem");
  two.take_from_other("identity.pem");
  check_refused(two.own, "identity.pem", "is not of the authority beside it");
}

TEST_CASE("what another authority permits, or somebody has changed, is refused by DDS") {
  const Two two;
  two.take_from_other("permissions.p7s");
  check_refused(two.own, "own", "DDS refuses it");
  const Two more;
  std::string governance = content(more.own / "governance.p7s");
  governance = std::regex_replace(
      governance, std::regex("(<allow_unauthenticated_participants>)false"), "$1true");
  std::ofstream(more.own / "governance.p7s") << governance;
  check_refused(more.own, "own", "DDS refuses it");
}

TEST_CASE("a graph is refused before its folder is made") {
  const Folder folder;
  const auto out = folder / "run";
  const auto said =
      run("erp launch launch/force_step.xml --security " + (folder / "none") + " --out " + out);
  CHECK(said.exit_code == 2);
  CHECK_THAT(said.output, Contains("no such folder; erp security make"));
  CHECK_FALSE(fs::exists(out));
  CHECK(run("erp launch launch/force_step.xml --security '' --out " + out).exit_code == 2);
}

TEST_CASE("a folder in use is not overwritten") {
  const Two two;
  const auto said = run("erp security make " + two.own.string());
  CHECK(said.exit_code == 2);
  CHECK_THAT(said.output, Contains("exists already"));
  CHECK(run("erp security make " + (two.folder / "new") + " --days 0").exit_code == 2);
}
