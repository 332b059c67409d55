#pragma once
#include <CLI/CLI.hpp>
#include <functional>
#include <iostream>
#include <sstream>
#include <string>
#include <thread>

#include "launch/erp/text/text_files.hpp"

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

/// An option's number must be above 0.
inline CLI::Validator above_zero() {
  return {[](std::string& said) {
            double value = 0;
            return CLI::detail::lexical_cast(said, value) && value > 0
                       ? std::string()
                       : said + " is not above 0; give a positive number";
          },
          ""};
}

}  // namespace launch
