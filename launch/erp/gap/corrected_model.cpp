#include "interfaces/xml/errors.hpp"
#include "interfaces/xml/writer.hpp"
#include "launch/erp/gap/files.hpp"
#include "launch/erp/text/text_files.hpp"

namespace launch::gap {
namespace {

/// Whether the file describes this robot.
bool describes(const std::string& file, const erp::Robot& robot) {
  try {
    return erp::write_robot(erp::read_robot(file)) == erp::write_robot(robot);
  } catch (const xml::Errors&) {
    return false;  // it includes files by paths relative to the folder of the original model
  }
}

}  // namespace

void write_corrected(const std::string& file, const std::string& model, const erp::Robot& corrected,
                     std::vector<erp::Effect> added) {
  std::string text = read_text(model), effects;
  for (erp::Effect& effect : added) effects += xml::Writer::text_of(effect, effect.element, 1);
  const auto end = text.rfind("</robot>");
  if (end != text.npos) {
    write_file(file, text.insert(end, effects));
    if (describes(file, corrected)) return;
  }
  write_file(file, erp::write_robot(corrected));
}

}  // namespace launch::gap
