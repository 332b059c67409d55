#include "launch/erp/run/run_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <ctime>
#include <deque>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace launch {
namespace fs = std::filesystem;

std::string utc_name(std::int64_t wall_ns) {
  const std::time_t seconds = wall_ns / 1'000'000'000;
  std::tm parts{};
  gmtime_r(&seconds, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H-%M-%SZ", &parts);
  return text;
}

std::string make_run_folder(const std::string& requested, const std::string& graph,
                            std::int64_t wall_ns) {
  fs::path folder = requested;
  if (requested.empty()) {
    const fs::path first = fs::path("erp_runs") / graph / utc_name(wall_ns);
    folder = first;
    for (int k = 2; fs::exists(folder); ++k) folder = first.string() + "-" + std::to_string(k);
  }
  std::error_code error;
  fs::create_directories(folder, error);
  if (error)
    throw std::invalid_argument(folder.string() + ": " + error.message() +
                                "; name another folder with --out DIR");
  return fs::canonical(folder).string();
}

FolderLock::FolderLock(const std::string& folder)
    : descriptor_(open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (descriptor_ < 0 || flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
  close(descriptor_);
  throw std::invalid_argument(folder + ": another run is writing here; name another folder with " +
                              "--out DIR");
}

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) close(descriptor_);
}

std::vector<std::string> last_lines(const std::string& file, std::size_t count) {
  std::ifstream stream(file);
  std::deque<std::string> lines;
  for (std::string line; std::getline(stream, line);) {
    lines.push_back(line);
    if (lines.size() > count) lines.pop_front();
  }
  return {lines.begin(), lines.end()};
}

}  // namespace launch
