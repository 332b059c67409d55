#pragma once
#include <cstdint>
#include <string>

#include "interfaces/recording/bytes.hpp"

namespace recording {

/// A file for appending. A failed append is undone: the file never ends with part of it. Every
/// error throws RecordingError with path and system error.
class OutputFile {
 public:
  /// `replace`: overwrites an existing file; without it an existing file is an error.
  OutputFile(std::string path, bool replace);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  void append(ByteView bytes);
  void sync();    ///< waits until the data is on the disk
  void close();   ///< sync, then close
  void remove();  ///< closes and deletes the file, unless it is a device
  std::uint64_t size() const { return size_; }
  std::uint32_t crc() const { return crc_; }  ///< CRC-32 of all appended bytes
  bool is_open() const { return descriptor_ >= 0; }
  const std::string& path() const { return path_; }

 private:
  [[noreturn]] void fail(const char* doing, int error) const;
  std::string path_;
  int descriptor_;
  std::uint64_t size_ = 0;
  std::uint32_t crc_ = 0;
};

/// A file with random read access.
class InputFile {
 public:
  explicit InputFile(std::string path);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  /// Returns `size` bytes from `offset`. Throws RecordingError when the file is too short.
  Bytes read(std::uint64_t offset, std::uint64_t size) const;
  std::uint64_t size() const { return size_; }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
  int descriptor_;
  std::uint64_t size_ = 0;
};

}  // namespace recording
