#include "launch/erp/run/input_files.hpp"

#include <fstream>
#include <iterator>

namespace launch {
namespace {

std::string content_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

}  // namespace

InputFiles::InputFiles(const std::vector<std::string>& files) {
  for (const auto& file : files) files_.emplace_back(file, content_of(file));
}

std::string InputFiles::changed() const {
  for (const auto& [file, content] : files_)
    if (content_of(file) != content) return file;
  return "";
}

}  // namespace launch
