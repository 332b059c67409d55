#pragma once
#include <string>

/// Text files and their folders. All functions throw std::invalid_argument with the file name.
namespace launch {

std::string read_text(const std::string& file);
void write_file(const std::string& file, const std::string& text);
/// Creates the folder and its parents if they do not exist.
void make_folder(const std::string& folder);
/// Checks that the folder can be created: creates it like make_folder, then removes the folders
/// that it created. Call it before a long computation that writes its result to `folder`.
void check_folder(const std::string& folder);

}  // namespace launch
