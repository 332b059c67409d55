#pragma once
#include <iosfwd>
#include <string>

/// `erp help`: reference of the XML formats, from the same descriptions as the XSD.
namespace launch {

/// Prints every element and attribute of robot.xml (`robot`) or of a graph (`graph`) with type, range, default and
/// meaning. Throws std::invalid_argument for another name.
void print_reference(const std::string& format, std::ostream& out);

}  // namespace launch
