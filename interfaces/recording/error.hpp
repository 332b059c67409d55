#pragma once
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

/// Recordings: MCAP files, message schemas, and tables for computation.
namespace recording {

/// An error in a recording; the message contains place, what and remedy.
struct RecordingError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Writing to the disk failed.
struct WriteError : RecordingError {
  using RecordingError::RecordingError;
};

/// `run.mcap: byte 1234: the chunk's checksum does not match; save what can be read with: …`
inline RecordingError error_at(std::string_view path, std::uint64_t byte, std::string_view what,
                               std::string_view remedy) {
  return RecordingError(std::string(path) + ": byte " + std::to_string(byte) + ": " +
                        std::string(what) + "; " + std::string(remedy));
}

/// Remedy for a damaged recording.
inline std::string recover_remedy(std::string_view path) {
  return "save what can be read with: erp log recover " + std::string(path) + " --out OUT.mcap";
}

}  // namespace recording
