#pragma once
#include <functional>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

/// `erp check FILE…`: every mistake in XML files, without starting anything.
namespace launch {

/// What a component says about its config file: the lines of its mistakes, "" when there are none,
/// nothing when no component of that type is known.
using CheckComponent =
    std::function<std::optional<std::string>(const std::string& type, const std::string& file)>;

/// Asks the component's own program: `PROGRAM --config FILE --check`. `find` gives the program of a
/// type, or "".
CheckComponent ask_program(std::function<std::string(const std::string& type)> find);

/// Checks each file by its root element: a robot, a graph with the robot and the configs it names,
/// or a component's config. Prints one line a mistake, or `FILE: ok`. Returns 0, or 2 when there
/// are mistakes.
int check(const std::vector<std::string>& files, std::ostream& out,
          const CheckComponent& component = {});

/// Prints the XSD of `kind`: robot or graph. Throws xml::Errors for another kind.
void print_schema(const std::string& kind, std::ostream& out);

}  // namespace launch
