#pragma once
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "interfaces/recording/mcap_reader.hpp"
#include "interfaces/recording/mcap_writer.hpp"

/// Shared by the recording tests: temporary folders, file contents, small recordings.
namespace test {

class Folder {
 public:
  Folder() {
    // In memory if possible: these tests write and sync thousands of files.
    std::filesystem::path base = "/dev/shm";
    if (!std::filesystem::is_directory(base)) base = std::filesystem::temp_directory_path();
    std::string name = (base / "erp_recording_XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::string operator/(const std::string& name) const { return (path_ / name).string(); }

 private:
  std::filesystem::path path_;
};

inline std::string read_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

inline void write_file(const std::string& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

/// Writes a recording with two channels, an attachment and `count` text messages. Returns its
/// bytes.
inline std::string small_recording(const std::string& path, recording::McapOptions options,
                                   int count) {
  recording::McapWriter writer(path, options);
  writer.attach("robot.xml", "text/xml", "<robot name=\"rig\"/>");
  const auto schema = writer.add_schema("std_msgs/msg/String", "ros2msg", "string data\n");
  const auto first = writer.add_channel("first", "cdr", schema, {{"writer", "a"}});
  const auto second = writer.add_channel("second", "cdr", schema);
  for (int i = 0; i < count; ++i) {
    const auto time_ns = static_cast<std::uint64_t>(1000 + i * 10);
    const auto sequence = static_cast<std::uint32_t>(i / 2);
    writer.write(i % 2 ? second : first, sequence, time_ns, time_ns - 3,
                 recording::view("message " + std::to_string(i)));
  }
  writer.close();
  return read_file(path);
}

/// The messages of a recording as text, in the order of reading.
inline std::vector<std::string> texts(const recording::McapReader& reader) {
  std::vector<std::string> texts;
  reader.for_each([&](const recording::Message& message) {
    texts.emplace_back(recording::text(message.data));
  });
  return texts;
}

}  // namespace test
