#pragma once
#include <sys/wait.h>

#include <unistd.h>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

#include "tests/components/node/domain.hpp"

/// System tests run the built programs from a shell, as users do.
namespace tests {

struct Outcome {
  int exit_code;
  std::string output;  ///< standard output and error
};

/// Runs a shell command with the built programs on PATH and waits for its end.
inline Outcome run(const std::string& command) {
  const std::string line =
      "PATH=" ERP_BIN_DIR ":$PATH; cd " ERP_SOURCE_DIR " && { " + command + "; } 2>&1";
  FILE* pipe = popen(line.c_str(), "r");
  if (!pipe) throw std::runtime_error("popen");
  std::string output;
  char buffer[4096];
  while (const auto n = fread(buffer, 1, sizeof buffer, pipe)) output.append(buffer, n);
  const int status = pclose(pipe);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), output};
}

/// A temporary folder, removed by the destructor.
class Folder {
 public:
  Folder() {
    auto name = (std::filesystem::temp_directory_path() / "erp_test_XXXXXX").string();
    if (!mkdtemp(name.data())) throw std::runtime_error("mkdtemp");
    path_ = name;
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string operator/(const std::string& name) const { return path_ + "/" + name; }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

inline std::string content(const std::string& file) {
  std::ifstream in(file);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

}  // namespace tests
