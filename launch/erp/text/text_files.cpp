#include "launch/erp/text/text_files.hpp"

#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "interfaces/xml/document.hpp"

namespace launch {

std::string read_text(const std::string& file) {
  constexpr std::uint64_t max_bytes = 256 << 20;  // chosen
  try {
    return xml::text_of_file(file, max_bytes);
  } catch (const xml::Errors& error) {
    throw std::invalid_argument(error.what());
  }
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
