#include "launch/erp/run/process.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cerrno>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>

using launch::Ending;
using launch::Process;
namespace fs = std::filesystem;

namespace {

/// A temporary folder for the logs of a test.
struct Folder {
  fs::path path;
  Folder() {
    std::string name = (fs::temp_directory_path() / "erp_process_XXXXXX").string();
    path = mkdtemp(name.data());
  }
  ~Folder() { fs::remove_all(path); }
  std::string log() const { return (path / "log").string(); }
  std::string read() const {
    std::ostringstream text;
    text << std::ifstream(log()).rdbuf();
    return text.str();
  }
};

Process shell(const std::string& script, const Folder& folder) {
  return Process({"/bin/sh", "-c", script}, folder.log());
}

Ending wait_for(Process& process) {
  pollfd polled{process.descriptor(), POLLIN, 0};
  while (poll(&polled, 1, -1) < 0 && errno == EINTR) {
  }
  return process.poll().value();
}

/// Waits until a script has written a line to its log.
std::string wait_for_line(const Folder& folder) {
  for (;;) {
    const auto text = folder.read();
    if (!text.empty() && text.back() == '\n') return text.substr(0, text.size() - 1);
    poll(nullptr, 0, 2);
  }
}

bool exists(pid_t pid) { return kill(pid, 0) == 0; }

/// Waits until the process has ended or is a zombie of init.
void wait_until_ended(pid_t pid) {
  for (;;) {
    std::ifstream stat("/proc/" + std::to_string(pid) + "/stat");
    std::string text;
    if (!std::getline(stat, text) || text.substr(text.rfind(')') + 2, 1) == "Z") return;
    poll(nullptr, 0, 2);
  }
}

}  // namespace

TEST_CASE("exit code and output of a process are returned") {
  Folder folder;
  auto process = shell("echo out; echo err >&2; exit 3", folder);
  const auto ending = wait_for(process);
  CHECK(ending.code == 3);
  CHECK(ending.signal == 0);
  CHECK_FALSE(ending.clean());
  CHECK(folder.read() == "out\nerr\n");
}

TEST_CASE("poll returns nothing for a running process and the same ending after its end") {
  Folder folder;
  auto process = shell("exec sleep 1000", folder);
  CHECK_FALSE(process.poll());
  process.send(SIGTERM);
  CHECK(wait_for(process).signal == SIGTERM);
  CHECK(process.poll()->signal == SIGTERM);
}

TEST_CASE("the text of an ending has exit code or signal name") {
  CHECK(launch::to_string(Ending{1, 0}) == "exit code 1");
  CHECK(launch::to_string(Ending{0, SIGKILL}) == "killed by signal 9 (Killed)");
}

TEST_CASE("starting a program that does not exist throws with its name and leaves no zombie") {
  Folder folder;
  CHECK_THROWS_WITH(Process({"/nowhere/at_all"}, folder.log()),
                    Catch::Matchers::Contains("/nowhere/at_all"));
  CHECK(waitpid(-1, nullptr, WNOHANG) == -1);
  CHECK(errno == ECHILD);
}

TEST_CASE("starting with a log that cannot be written throws") {
  CHECK_THROWS_AS(Process({"/bin/true"}, "/nowhere/log"), std::system_error);
}

TEST_CASE("a process that has ended is not a zombie after poll") {
  Folder folder;
  auto process = shell("exit 0", folder);
  wait_for(process);
  CHECK_FALSE(exists(process.pid()));
}

TEST_CASE("destroying a Process kills the program and its children") {
  Folder folder;
  pid_t parent = 0, child = 0;
  {
    auto process = shell("sleep 1000 & echo $!; wait", folder);
    parent = process.pid();
    child = std::stoi(wait_for_line(folder));
  }
  CHECK_FALSE(exists(parent));
  wait_until_ended(child);
}

TEST_CASE("children of a process are killed when it ends") {
  Folder folder;
  auto process = shell("sleep 1000 & echo $!", folder);
  const pid_t child = std::stoi(wait_for_line(folder));
  CHECK(wait_for(process).clean());
  wait_until_ended(child);
}

TEST_CASE("a process inherits no descriptor except its log, even one opened without O_CLOEXEC") {
  Folder folder;
  const int without_cloexec = open("/dev/null", O_RDONLY);
  auto process = shell("ls /proc/self/fd | wc -l", folder);
  wait_for(process);
  close(without_cloexec);
  CHECK(std::stoi(folder.read()) == 4);  // 0, 1, 2 and the folder opened by ls
}

TEST_CASE("a process receives signals that the launcher blocks") {
  sigset_t blocked, before;
  sigemptyset(&blocked);
  sigaddset(&blocked, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &blocked, &before);
  Folder folder;
  auto process = shell("exec sleep 1000", folder);
  process.send(SIGTERM);
  CHECK(wait_for(process).signal == SIGTERM);
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

TEST_CASE("a process does not survive a killed launcher") {
  Folder folder;
  const pid_t launcher = fork();
  if (launcher == 0) {
    const auto process = shell("echo $$; exec sleep 1000", folder);
    for (;;) pause();
  }
  const pid_t child = std::stoi(wait_for_line(folder));
  kill(launcher, SIGKILL);
  waitpid(launcher, nullptr, 0);
  wait_until_ended(child);
}

TEST_CASE("a second process appends to the log") {
  Folder folder;
  for (int i = 0; i < 2; ++i) {
    auto process = shell("echo again", folder);
    wait_for(process);
  }
  CHECK(folder.read() == "again\nagain\n");
}
