#pragma once
#include <iostream>

#include "interfaces/recording/error.hpp"

/// Error handling of verbs that read recordings.
namespace launch {

/// Runs `work` and returns its exit code. Prints an error of the recording on stderr and returns 1
/// (cannot be written) or 2 (cannot be read).
template <class Work>
int guarded(Work&& work) {
  try {
    return work();
  } catch (const recording::WriteError& error) {
    std::cerr << error.what() << '\n';
    return 1;
  } catch (const recording::RecordingError& error) {
    std::cerr << error.what() << '\n';
    return 2;
  }
}

/// Flushes `out` and returns 0. Throws WriteError when that fails.
inline int flush_or_throw(std::ostream& out) {
  if (out.flush()) return 0;
  throw recording::WriteError(
      "the output could not be written; free some space or name another file");
}

}  // namespace launch
