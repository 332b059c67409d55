// Target: arbitrary text as a candump recording, line by line and as a bus that replays it.
#include "hal/can/trace.hpp"

#include <array>
#include <cmath>
#include <stdexcept>

#include "tests/fuzz/input.hpp"

namespace {

bool are_equal(const erp::CanFrame& a, const erp::CanFrame& b) {
  return a.id == b.id && a.size == b.size && std::memcmp(a.data, b.data, a.size) == 0;
}

void read_lines(std::string_view text) {
  while (!text.empty()) {
    const auto line_end = std::min(text.find('\n'), text.size());
    const auto line = erp::parse_trace_line(std::string(text.substr(0, line_end)));
    text.remove_prefix(std::min(line_end + 1, text.size()));
    if (!line) continue;
    fuzz::require(std::isfinite(line->time_s), "a frame has a time");
    const auto reread_line = erp::parse_trace_line(erp::trace_line(line->frame, 0, "can0"));
    fuzz::require(reread_line && are_equal(reread_line->frame, line->frame),
                  "a frame reads back unchanged");
  }
}

void play(const std::string& file) {
  try {
    const auto bus = erp::open_bus("trace:" + file);
    std::array<erp::CanFrame, 8> frames;
    bus->receive(frames, 0.001);
  } catch (const std::runtime_error&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const fuzz::Folder folder;
  read_lines({reinterpret_cast<const char*>(data), size});
  play(folder.write("run.log", data, size));
  return 0;
}
