#include "launch/erp/check.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <ostream>
#include <set>
#include <system_error>

#include "interfaces/graph/graph.hpp"
#include "interfaces/robot/robot.hpp"
#include "interfaces/xml/xml.hpp"

namespace launch {
namespace {

/// Checks files, each once, and whatever a graph names.
class Checker {
 public:
  Checker(std::ostream& out, const CheckComponent& component) : out_(out), component_(component) {}

  void check(const std::string& file) {
    std::error_code ignored;
    if (!done_.insert(std::filesystem::weakly_canonical(file, ignored).string()).second) return;
    try {
      check_as(xml::read_document(file), file);
    } catch (const xml::Errors& errors) {
      complain(errors.what());
    }
  }
  int exit_code() const { return sound_ ? 0 : 2; }

 private:
  void check_as(const xml::Element& root, const std::string& file) {
    if (root.name == erp::Robot::element) {
      erp::read_robot(file);
      praise(file);
    } else if (root.name == erp::Graph::element) {
      const erp::Graph graph = erp::read_graph(file);
      praise(file);
      check(graph.robot);
      for (const erp::GraphComponent& line : graph.components)
        if (!line.config.empty()) check(line.config);
    } else {
      check_config(root, file);
    }
  }

  void check_config(const xml::Element& root, const std::string& file) {
    const auto mistakes = component_ ? component_(root.name, file) : std::nullopt;
    if (!mistakes)
      complain(to_string(
          xml::error_in(root.name, root.place, "no component of this type is installed",
                        xml::did_you_mean(root.name, {erp::Robot::element, erp::Graph::element}) +
                            ", or the type of a component")));
    else if (!mistakes->empty()) complain(*mistakes);
    else praise(file);
  }

  void praise(const std::string& file) { out_ << file << ": ok\n"; }
  void complain(const std::string& lines) {
    sound_ = false;
    out_ << lines << (lines.ends_with('\n') ? "" : "\n");
  }

  std::ostream& out_;
  const CheckComponent& component_;
  std::set<std::string> done_;
  bool sound_ = true;
};

struct Finished {
  int status = 0;
  std::string complaints;
};

/// Runs a program to its end and collects what it writes to stderr.
Finished run_to_end(std::vector<std::string> argv) {
  std::array<int, 2> ends{};
  if (pipe2(ends.data(), O_CLOEXEC) != 0)
    throw std::system_error(errno, std::generic_category(), "pipe");
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
  std::vector<char*> pointers;
  pointers.reserve(argv.size() + 1);
  for (std::string& argument : argv) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  pid_t pid = -1;
  const int fault = posix_spawn(&pid, pointers[0], &actions, nullptr, pointers.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  Finished finished;
  std::array<char, 4096> buffer{};
  for (ssize_t n; (n = read(ends[0], buffer.data(), buffer.size())) > 0;)
    finished.complaints.append(buffer.data(), static_cast<std::size_t>(n));
  close(ends[0]);
  if (fault != 0) throw std::system_error(fault, std::generic_category(), argv[0]);
  waitpid(pid, &finished.status, 0);
  return finished;
}

}  // namespace

CheckComponent ask_program(std::function<std::string(const std::string&)> find) {
  return [find = std::move(find)](const std::string& type,
                                  const std::string& file) -> std::optional<std::string> {
    const std::string program = find(type);
    if (program.empty()) return std::nullopt;
    const Finished finished = run_to_end({program, "--check", file});
    if (finished.status == 0) return "";
    if (!finished.complaints.empty()) return finished.complaints;
    return file + ": " + program + " --check failed without a word; run it by hand";
  };
}

int check(const std::vector<std::string>& files, std::ostream& out,
          const CheckComponent& component) {
  Checker checker(out, component);
  for (const std::string& file : files) checker.check(file);
  return checker.exit_code();
}

void print_schema(const std::string& kind, std::ostream& out) {
  if (kind == erp::Robot::element) out << xml::schema<erp::Robot>();
  else if (kind == erp::Graph::element) out << xml::schema<erp::Graph>();
  else
    throw xml::Errors({{{"--schema " + kind, 0, 0},
                        "there is no such schema",
                        xml::did_you_mean(kind, {erp::Robot::element, erp::Graph::element})}});
}

}  // namespace launch
