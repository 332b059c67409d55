#include "launch/erp/inspect/reference.hpp"

#include <ostream>
#include <stdexcept>

#include "interfaces/graph/graph.hpp"
#include "interfaces/robot/robot.hpp"
#include "interfaces/xml/words.hpp"
#include "interfaces/xml/xml.hpp"

namespace launch {

void print_reference(const std::string& format, std::ostream& out) {
  if (format != erp::Robot::element && format != erp::Graph::element)
    throw std::invalid_argument(
        "help: no XML format \"" + format + "\"; " +
        xml::did_you_mean(format, {erp::Robot::element, erp::Graph::element}) +
        "; parameters of a component: its program with --help");
  out << "<" << format
      << ">: attributes, and elements in <>, indented below their element. The unit of an "
         "attribute is "
      << "part of its name.\n\n"
      << (format == erp::Robot::element ? xml::describe<erp::Robot>()
                                        : xml::describe<erp::Graph>());
}

}  // namespace launch
