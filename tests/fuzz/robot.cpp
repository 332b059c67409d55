// Target: arbitrary text as robot.xml. Its folder has files that the text may include and mirror.
#include "interfaces/robot/robot.hpp"

#include "interfaces/xml/errors.hpp"
#include "tests/fuzz/input.hpp"

namespace {

fuzz::Folder make_folder() {
  fuzz::Folder folder;
  for (const auto* part : {"part.xml", "types.xml"})
    std::filesystem::copy_file(std::filesystem::path(ERP_PARTS_DIR) / part, folder / part);
  return folder;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::Folder folder = make_folder();
  std::string written;
  try {
    written = erp::write_robot(erp::read_robot(folder.write("robot.xml", data, size)));
  } catch (const xml::Errors&) {
    return 0;
  }
  const erp::Robot reread_robot = erp::read_robot(folder.write("written.xml", written));
  fuzz::require(erp::write_robot(reread_robot) == written, "a robot reads back unchanged");
  return 0;
}
