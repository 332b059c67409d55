#pragma once
#include <functional>
#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

/// `erp check FILE…`: all errors in XML files, without starting a graph.
namespace launch {

/// Checks the config file of a component. Returns its errors, one per line; "" if there are none;
/// nullopt if the component type is unknown.
using CheckComponent =
    std::function<std::optional<std::string>(const std::string& type, const std::string& file)>;

/// Checks by the program of the component: `PROGRAM --config FILE --check`. `find` returns the
/// program of a type, or "" if there is none.
CheckComponent check_by_program(std::function<std::string(const std::string& type)> find);

/// Checks each file according to its root element: a robot; a graph, with its robot and configs; a
/// config. Prints one line per error, or `FILE: ok`. Returns 0, or 2 if there are errors.
int check(const std::vector<std::string>& files, std::ostream& out,
          const CheckComponent& component = {});

/// Prints the XSD of `kind`: robot or graph. Throws xml::Errors for another kind.
void print_schema(const std::string& kind, std::ostream& out);

}  // namespace launch
