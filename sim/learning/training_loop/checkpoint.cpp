#include "sim/learning/training_loop/checkpoint.hpp"

#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace sim::training_loop {

void write_checkpoint(const std::string& file, const std::string& text) {
  const std::string fresh = file + ".new";
  {
    std::ofstream out(fresh, std::ios::binary);
    if (!(out << text << std::flush)) throw std::invalid_argument(fresh + ": cannot be written");
  }
  std::filesystem::rename(fresh, file);
}

}  // namespace sim::training_loop
