#pragma once
#include <set>
#include <string>
#include <vector>

/// The files that are valid against the schema according to xmllint. Throws std::runtime_error when
/// xmllint is not installed or the schema is invalid.
std::set<std::string> valid_by_schema(const std::string& schema_file,
                                      const std::vector<std::string>& files);

/// Writes the text to a file in the temporary folder and returns its name.
std::string temporary(const std::string& name, const std::string& text);
