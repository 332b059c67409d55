#pragma once
#include <CLI/CLI.hpp>
#include <functional>
#include <iostream>
#include <sstream>
#include <string>
#include <thread>

#include "launch/erp/text/text_files.hpp"

/// Helpers of all verbs.
namespace launch {

/// Prints to stdout, or writes to `file` if its name is not empty. Writes only after `print` has
/// returned, because `print` may read that file. Returns the exit code of `print`.
inline int write_output(const std::string& file, const std::function<int(std::ostream&)>& print) {
  std::ostringstream text;
  const int code = print(text);
  if (file.empty()) return std::cout << text.str(), code;
  write_file(file, text.str());
  return code;
}

inline int all_cores() {
  return static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
}

/// Accepts numbers above 0.
inline CLI::Validator above_zero() {
  return {[](std::string& text) {
            double value = 0;
            return CLI::detail::lexical_cast(text, value) && value > 0
                       ? std::string()
                       : text + " is not above 0; give a positive number";
          },
          ""};
}

}  // namespace launch
