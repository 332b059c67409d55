#pragma once
#include <filesystem>
#include <string>
#include <vector>

/// `erp security make DIR`: what a robot's processes need to know each other by.
namespace launch {

/// When its certificates are valid, seconds since 1970.
struct Validity {
  std::int64_t from_s = 0, until_s = 0;
};
/// From a day ago, for the robot's other machines whose clocks are behind, for so many days.
Validity valid_for_days(int days);

/// Writes an authority, an identity that it vouches for, and what it permits, into a folder that
/// must not exist or be empty; returns the files. Keys are for their owner alone.
/// Throws std::invalid_argument for a folder in use, std::runtime_error when a file cannot be
/// written.
std::vector<std::filesystem::path> make_security(const std::filesystem::path& folder,
                                                 const Validity& validity);

}  // namespace launch
