#pragma once
#include <string>
#include <utility>
#include <vector>

namespace launch {

/// The input files of a run as they were at its start. A component that is restarted reads its files
/// again; it must not get others than the rest of the graph.
class InputFiles {
 public:
  explicit InputFiles(const std::vector<std::string>& files);
  /// The first file whose content has changed since; empty: none.
  std::string changed() const;

 private:
  std::vector<std::pair<std::string, std::string>> files_;  ///< name, content
};

}  // namespace launch
