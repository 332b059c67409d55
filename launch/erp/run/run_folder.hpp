#pragma once
#include <cstdint>
#include <string>
#include <vector>

/// The folder for the logs and the recording of a run.
namespace launch {

/// "2025-01-31T23-59-59Z", usable as a file name.
std::string utc_name(std::int64_t wall_ns);

/// Creates the folder `requested`. If it is empty, creates `erp_runs/<graph>/<UTC time>` in the
/// current folder, with suffix "-2", "-3" … if that folder exists. Returns the absolute path.
/// Throws std::invalid_argument when the folder cannot be created.
std::string make_run_folder(const std::string& requested, const std::string& graph,
                            std::int64_t wall_ns);

/// Locks the folder of a run, because two runs in one folder would mix their files. The lock ends
/// with the process.
class FolderLock {
 public:
  /// Throws std::invalid_argument when another run has locked the folder.
  explicit FolderLock(const std::string& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  int descriptor_;
};

/// The last `count` lines of a file, or all lines if it has fewer; empty if the file does not
/// exist.
std::vector<std::string> last_lines(const std::string& file, std::size_t count);

}  // namespace launch
