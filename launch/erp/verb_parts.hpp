#pragma once
#include <functional>
#include <iostream>
#include <sstream>
#include <string>
#include <thread>

#include "launch/text/text_files.hpp"

/// What verbs have in common.
namespace launch {

/// Prints, or writes a file: only once all is computed, because what is read may include that file.
inline int give(const std::string& file, const std::function<int(std::ostream&)>& print) {
  std::ostringstream text;
  const int code = print(text);
  if (file.empty()) return std::cout << text.str(), code;
  write_file(file, text.str());
  return code;
}

inline int all_cores() {
  return static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

}  // namespace launch
