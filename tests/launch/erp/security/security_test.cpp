// Folders of `erp security make`: a process uses a valid folder and rejects an invalid one.
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

/// One folder of each of two authorities.
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

Outcome list_components(const fs::path& security) {
  return run("ERP_SECURITY=" + security.string() + " erp ps");
}

/// A tool and a component reject the folder with exit code 2, place, reason and remedy.
void check_refused(const fs::path& security, const std::string& place, const std::string& why) {
  const auto with = "ERP_SECURITY=" + security.string() + " ";
  const auto robot = "configs/hinge_rig/robot.xml";
  for (const auto& command :
       {with + "erp ps", with + "'" ERP_TEST_COMPONENTS "/worker' --robot " + robot}) {
    const auto result = run(command);
    INFO(command << '\n' << result.output);
    CHECK(result.exit_code == 2);
    CHECK_THAT(result.output, Contains(place) && Contains(why) && Contains("; "));
  }
}

}  // namespace

TEST_CASE("a process with a certificate joins, and only the owner can read the keys") {
  const Two two;
  const auto result = list_components(two.own);
  INFO(result.output);
  CHECK(result.exit_code == 0);
  for (const auto* key : {"authority.key", "identity.key"})
    CHECK((fs::status(two.own / key).permissions() & fs::perms::all) ==
          (fs::perms::owner_read | fs::perms::owner_write));
  CHECK((fs::status(two.own).permissions() & fs::perms::all) == fs::perms::owner_all);
}

TEST_CASE("a process joins without authority.key") {
  const Two two;
  fs::remove(two.own / "authority.key");
  CHECK(list_components(two.own).exit_code == 0);
}

namespace {

/// A security configuration that cannot work.
constexpr auto own_security =
    "<Security><Authentication><Library path=\"none\"/><IdentityCertificate>file:none"
    "</IdentityCertificate><IdentityCA>file:none</IdentityCA><PrivateKey>file:none</PrivateKey>"
    "</Authentication></Security>";

std::string cyclone_config(const std::string& file, const std::string& more) {
  std::ofstream(file) << "<CycloneDDS><Domain Id=\"any\"><General><Interfaces><NetworkInterface "
                         "name=\"lo\"/></Interfaces></General>"
                      << more << "</Domain></CycloneDDS>";
  return "CYCLONEDDS_URI=file://" + file + " ";
}

}  // namespace

TEST_CASE(
    "a configuration in CYCLONEDDS_URI is protected as well and cannot disable the protection") {
  const Two two;
  const auto open = cyclone_config(two.folder / "open.xml", ""),
             closed = cyclone_config(two.folder / "closed.xml", own_security);
  const auto command = "ERP_SECURITY=" + two.own.string() + " erp ps";
  CHECK(run(open + command).exit_code == 0);
  CHECK(run(closed + command).exit_code == 0);
  CHECK(run(closed + "erp ps").exit_code != 0);
  two.take_from_other("permissions.p7s");
  CHECK(run(open + command).exit_code == 2);
}

TEST_CASE("a missing folder or file is named") {
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

TEST_CASE("a key that other users can read is rejected") {
  const Two two;
  const auto key = two.own / "identity.key";
  fs::permissions(key, fs::perms::group_read, fs::perm_options::add);
  check_refused(two.own, "identity.key", "mode 0640; chmod 600");
}

TEST_CASE("an expired or not yet valid certificate is rejected") {
  const Folder folder;
  const auto now_s = launch::valid_for_days(0).until_s;
  launch::make_security(folder / "old", {now_s - 1000, now_s - 10});
  launch::make_security(folder / "early", {now_s + 1000, now_s + 2000});
  check_refused(folder / "old", "authority.pem", "expired on");
  check_refused(folder / "early", "authority.pem", "is not valid before");
}

TEST_CASE("key and certificate of another authority are rejected") {
  const Two two;
  two.take_from_other("identity.key");
  check_refused(two.own, "identity.key", "is not the key of identity.pem");
  two.take_from_other("identity.pem");
  check_refused(two.own, "identity.pem", "was not issued by the authority in this folder");
}

TEST_CASE("DDS rejects permissions of another authority and a changed governance document") {
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

TEST_CASE("a graph with an invalid security folder is rejected before its run folder is created") {
  const Folder folder;
  const auto out = folder / "run";
  const auto result =
      run("erp launch launch/force_step.xml --security " + (folder / "none") + " --out " + out);
  CHECK(result.exit_code == 2);
  CHECK_THAT(result.output, Contains("no such folder; erp security make"));
  CHECK_FALSE(fs::exists(out));
  CHECK(run("erp launch launch/force_step.xml --security '' --out " + out).exit_code == 2);
}

TEST_CASE("security make rejects a folder that is not empty") {
  const Two two;
  const auto result = run("erp security make " + two.own.string());
  CHECK(result.exit_code == 2);
  CHECK_THAT(result.output, Contains("exists already"));
  CHECK(run("erp security make " + (two.folder / "new") + " --days 0").exit_code == 2);
}
