#pragma once
#include <cstdint>
#include <string>
#include <vector>

/// The folder in which a run leaves its logs and its recording.
namespace launch {

/// "2025-01-31T23-59-59Z", fit for a file name.
std::string utc_name(std::int64_t wall_ns);

/// `wished`, or `erp_runs/<graph>/<UTC time>` under the current folder, with "-2", "-3" … behind
/// when that exists. Creates it and returns its absolute path.
/// Throws std::invalid_argument when it cannot be created.
std::string make_run_folder(const std::string& wished, const std::string& graph,
                            std::int64_t wall_ns);

/// A run's claim on its folder: two runs in one would mix their files. Ends with its process.
class FolderClaim {
 public:
  /// Throws std::invalid_argument when another run has it.
  explicit FolderClaim(const std::string& folder);
  ~FolderClaim();
  FolderClaim(const FolderClaim&) = delete;
  FolderClaim& operator=(const FolderClaim&) = delete;

 private:
  int descriptor_;
};

/// The last `count` lines of a file; fewer when it has fewer, none when it is not there.
std::vector<std::string> last_lines(const std::string& file, std::size_t count);

}  // namespace launch
