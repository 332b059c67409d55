#pragma once
#include <string>

/// Files of text, and the folders they go to. All throw std::invalid_argument with the name.
namespace launch {

std::string read_text(const std::string& file);
void write_file(const std::string& file, const std::string& text);
/// With those above it, if they are not there.
void make_folder(const std::string& folder);
/// Throws as make_folder would, and leaves nothing behind: before long work whose result goes there.
void check_folder(const std::string& folder);

}  // namespace launch
