#include "sim/learning/training_loop/checkpoint.hpp"

#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace sim::training_loop {

void write_checkpoint(const std::string& file, const std::string& text) {
  const std::string new_file = file + ".new";
  {
    std::ofstream out(new_file, std::ios::binary);
    if (!(out << text << std::flush)) throw std::invalid_argument(new_file + ": cannot be written");
  }
  std::filesystem::rename(new_file, file);
}

}  // namespace sim::training_loop
