#pragma once
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

/// Recordings: MCAP files in and out, message schemas, and the table a person computes with.
namespace recording {

/// What is wrong with a recording: place, what, remedy.
struct RecordingError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The disk refused what was to be written.
struct WriteError : RecordingError {
  using RecordingError::RecordingError;
};

/// `run.mcap: byte 1234: the chunk's checksum does not match; mend it with …`
inline RecordingError error_at(std::string_view path, std::uint64_t byte, std::string_view what,
                               std::string_view remedy) {
  return RecordingError(std::string(path) + ": byte " + std::to_string(byte) + ": " +
                        std::string(what) + "; " + std::string(remedy));
}

/// For what a wrong byte in a recording calls for.
inline std::string mend(std::string_view path) {
  return "save what can be read with: erp log recover " + std::string(path) + " --out OUT.mcap";
}

}  // namespace recording
