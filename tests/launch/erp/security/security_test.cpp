// Folders of `erp security make`: a process uses a valid folder and rejects an invalid one.
#include "launch/erp/security/security.hpp"

#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <regex>

#include "tests/system/command.hpp"

using Catch::Matchers::Contains;
namespace fs = std::filesystem;
using namespace tests;

namespace {

/// Two security folders, each of its own authority.
struct TwoAuthorities {
  Folder folder;
  fs::path own = folder / "own", other = folder / "other";
  TwoAuthorities() { make(own), make(other); }
  static void make(const fs::path& directory) {
    launch::make_security(directory, launch::valid_for_days(1));
  }
  void take_from_other(const char* file) const {
    fs::copy_file(other / file, own / file, fs::copy_options::overwrite_existing);
  }
};

Outcome list_components(const fs::path& security) {
  return run("ERP_SECURITY=" + security.string() + " erp ps");
}

/// A tool and a component reject the folder with exit code 2. Both print file, reason and remedy.
void check_rejected(const fs::path& security, const std::string& file, const std::string& reason) {
  const auto with = "ERP_SECURITY=" + security.string() + " ";
  const auto robot = "configs/hinge_rig/robot.xml";
  for (const auto& command :
       {with + "erp ps", with + "'" ERP_TEST_COMPONENTS "/worker' --robot " + robot}) {
    const auto result = run(command);
    INFO(command << '\n' << result.output);
    CHECK(result.exit_code == 2);
    CHECK_THAT(result.output, Contains(file) && Contains(reason) && Contains("; "));
  }
}

}  // namespace

TEST_CASE("a process with a certificate joins, and only the owner can read the keys") {
  const TwoAuthorities authorities;
  const auto result = list_components(authorities.own);
  INFO(result.output);
  CHECK(result.exit_code == 0);
  for (const auto* key : {"authority.key", "identity.key"})
    CHECK((fs::status(authorities.own / key).permissions() & fs::perms::all) ==
          (fs::perms::owner_read | fs::perms::owner_write));
  CHECK((fs::status(authorities.own).permissions() & fs::perms::all) == fs::perms::owner_all);
}

TEST_CASE("a process joins without authority.key") {
  const TwoAuthorities authorities;
  fs::remove(authorities.own / "authority.key");
  CHECK(list_components(authorities.own).exit_code == 0);
}

namespace {

/// A security configuration whose files do not exist.
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

TEST_CASE("a configuration in CYCLONEDDS_URI is also protected and cannot disable the protection") {
  const TwoAuthorities authorities;
  const auto open = cyclone_config(authorities.folder / "open.xml", ""),
             closed = cyclone_config(authorities.folder / "closed.xml", own_security);
  const auto command = "ERP_SECURITY=" + authorities.own.string() + " erp ps";
  CHECK(run(open + command).exit_code == 0);
  CHECK(run(closed + command).exit_code == 0);
  CHECK(run(closed + "erp ps").exit_code != 0);
  authorities.take_from_other("permissions.p7s");
  CHECK(run(open + command).exit_code == 2);
}

TEST_CASE("a missing folder or file is named") {
  const TwoAuthorities authorities;
  check_rejected(authorities.folder / "none", "none", "no such folder");
  for (const auto* file :
       {"authority.pem", "identity.pem", "identity.key", "governance.p7s", "permissions.p7s"}) {
    const fs::path moved = authorities.folder / "away";
    fs::rename(authorities.own / file, moved);
    check_rejected(authorities.own, file, "is missing");
    fs::rename(moved, authorities.own / file);
  }
  check_rejected("", "ERP_SECURITY", "is empty");
}

TEST_CASE("a key that other users can read is rejected") {
  const TwoAuthorities authorities;
  const auto key = authorities.own / "identity.key";
  fs::permissions(key, fs::perms::group_read, fs::perm_options::add);
  check_rejected(authorities.own, "identity.key", "mode 0640; chmod 600");
}

TEST_CASE("a folder that other users can change, or that belongs to another user, is rejected") {
  const TwoAuthorities authorities;
  fs::permissions(authorities.own, fs::perms::others_write, fs::perm_options::add);
  check_rejected(authorities.own, "own", "mode 0702; chmod 700");
  fs::permissions(authorities.own, fs::perms::owner_all);
  if (geteuid() != 0) return;  // only root can give a folder away
  REQUIRE(chown(authorities.own.c_str(), 1234, 1234) == 0);
  check_rejected(authorities.own, "own", "belongs to another user, number 1234");
}

TEST_CASE("an expired or not yet valid certificate is rejected") {
  const Folder folder;
  const auto now_s = launch::valid_for_days(0).until_s;
  launch::make_security(folder / "old", {now_s - 1000, now_s - 10});
  launch::make_security(folder / "early", {now_s + 1000, now_s + 2000});
  check_rejected(folder / "old", "authority.pem", "expired on");
  check_rejected(folder / "early", "authority.pem", "is not valid before");
}

TEST_CASE("key and certificate of another authority are rejected") {
  const TwoAuthorities authorities;
  authorities.take_from_other("identity.key");
  check_rejected(authorities.own, "identity.key", "is not the key of identity.pem");
  authorities.take_from_other("identity.pem");
  check_rejected(authorities.own, "identity.pem", "was not issued by the authority in this folder");
}

TEST_CASE("DDS rejects permissions of another authority and a changed governance document") {
  const TwoAuthorities authorities;
  authorities.take_from_other("permissions.p7s");
  check_rejected(authorities.own, "own", "DDS refuses it");
  const TwoAuthorities changed;
  std::string governance = content(changed.own / "governance.p7s");
  governance = std::regex_replace(
      governance, std::regex("(<allow_unauthenticated_participants>)false"), "$1true");
  std::ofstream(changed.own / "governance.p7s") << governance;
  check_rejected(changed.own, "own", "DDS refuses it");
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
  const TwoAuthorities authorities;
  const auto result = run("erp security make " + authorities.own.string());
  CHECK(result.exit_code == 2);
  CHECK_THAT(result.output, Contains("exists already"));
  CHECK(run("erp security make " + (authorities.folder / "new") + " --days 0").exit_code == 2);
}
