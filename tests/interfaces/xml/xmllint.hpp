#pragma once
#include <set>
#include <string>
#include <vector>

/// Of `files`, those that xmllint finds valid against the schema.
/// Throws std::runtime_error when xmllint is not installed or the schema itself is wrong.
std::set<std::string> valid_by_schema(const std::string& schema_file,
                                      const std::vector<std::string>& files);

/// Writes the text to a file in the temporary folder and returns its name.
std::string temporary(const std::string& name, const std::string& text);
