#pragma once
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

/// A temporary file with a given content, removed by the destructor.
struct File {
  std::string path;
  explicit File(const std::string& text, const std::string& ending = ".xml")
      : path(std::filesystem::temp_directory_path() /
             ("erp_" + std::to_string(getpid()) + ending)) {
    std::ofstream(path) << text;
  }
  ~File() { std::filesystem::remove(path); }
};
