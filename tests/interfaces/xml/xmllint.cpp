#include "tests/interfaces/xml/xmllint.hpp"

#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <stdexcept>

std::set<std::string> valid_by_schema(const std::string& schema_file,
                                      const std::vector<std::string>& files) {
  std::string command = "xmllint --nonet --noout --schema '" + schema_file + "'";
  for (const std::string& file : files) command += " '" + file + "'";
  const std::unique_ptr<FILE, int (*)(FILE*)> out(popen((command + " 2>&1").c_str(), "r"), pclose);
  std::set<std::string> valid;
  std::string output;
  for (char line[4096]; std::fgets(line, sizeof line, out.get());) {
    const std::string text = line;
    output += text;
    if (text.ends_with(" validates\n")) valid.insert(text.substr(0, text.size() - 11));
  }
  if (output.find("not found") != output.npos || output.find("failed to compile") != output.npos)
    throw std::runtime_error(output);
  return valid;
}

std::string temporary(const std::string& name, const std::string& text) {
  const auto file =
      std::filesystem::temp_directory_path() / ("erp_" + std::to_string(getpid()) + "_" + name);
  std::ofstream(file) << text;
  return file.string();
}
