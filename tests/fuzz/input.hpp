#pragma once
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <span>
#include <string>
#include <string_view>

/// Shared code of the targets: libFuzzer's bytes as values and as files, and checks of invariants.
namespace fuzz {

/// Takes values from the front of the bytes. After the last byte, every value is zero.
class Input {
 public:
  Input(const std::uint8_t* data, std::size_t size) : remaining_(data, size) {}
  bool empty() const { return remaining_.empty(); }

  template <class T>
  T take() {
    T value{};
    const auto source = bytes(sizeof value);
    if (!source.empty()) std::memcpy(&value, source.data(), source.size());
    return value;
  }
  std::span<const std::uint8_t> bytes(std::size_t max_count) {
    const auto front = remaining_.first(std::min(max_count, remaining_.size()));
    remaining_ = remaining_.subspan(front.size());
    return front;
  }

 private:
  std::span<const std::uint8_t> remaining_;
};

/// Checks an invariant. Prints it and aborts if it is violated.
inline void require(bool is_satisfied, const char* invariant) {
  if (is_satisfied) return;
  std::cerr << "violated: " << invariant << std::endl;
  std::abort();
}

/// A temporary folder of this process. libFuzzer exits without destructors, so run.sh creates
/// TMPDIR (in memory if possible) and removes it.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "erp_fuzz_XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }

  std::string write(const std::string& name, std::string_view bytes) const {
    std::ofstream(path_ / name, std::ios::binary) << bytes;
    return *this / name;
  }
  std::string write(const std::string& name, const std::uint8_t* data, std::size_t size) const {
    return write(name, {reinterpret_cast<const char*>(data), size});
  }

 private:
  std::filesystem::path path_;
};

}  // namespace fuzz
