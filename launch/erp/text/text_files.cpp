#include "launch/erp/text/text_files.hpp"

#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace launch {

std::string read_text(const std::string& file) {
  if (std::filesystem::is_directory(file))
    throw std::invalid_argument(file + ": this is a folder; name a file in it");
  std::ifstream in(file);
  if (!in) throw std::invalid_argument(file + ": cannot be read; check the name");
  return {std::istreambuf_iterator<char>(in), {}};
}

void write_file(const std::string& file, const std::string& text) {
  std::ofstream out(file);
  if (!(out << text) || !out.flush())
    throw std::invalid_argument(file + ": cannot be written; name another file");
}

void make_folder(const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    throw std::invalid_argument(folder + ": this folder cannot be made: " + error.message() +
                                "; name another folder");
}

void check_folder(const std::string& folder) {
  namespace fs = std::filesystem;
  fs::path first_created;
  for (fs::path path = fs::absolute(folder); !fs::exists(path); path = path.parent_path())
    first_created = path;
  make_folder(folder);
  if (!first_created.empty()) fs::remove_all(first_created);
}

}  // namespace launch
