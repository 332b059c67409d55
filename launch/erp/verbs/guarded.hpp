#pragma once
#include <iostream>

#include "interfaces/recording/error.hpp"

/// What verbs that read recordings have in common.
namespace launch {

/// Runs `work`; says what went wrong on stderr, and as an exit code.
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

inline int written(std::ostream& out) {
  if (out.flush()) return 0;
  throw recording::WriteError(
      "the output could not be written; free some space or name another file");
}

}  // namespace launch
