#include "hal/can/trace.hpp"

#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <stdexcept>

namespace erp {
namespace {

template <class Number>
bool read_hex(const char* begin, const char* end, Number& value) {
  const auto [stop, error] = std::from_chars(begin, end, value, 16);
  return error == std::errc() && stop == end;
}

/// `123#DEADBEEF`: three digits of an identifier, then two per byte.
std::optional<CanFrame> parse_frame(const std::string& text) {
  CanFrame frame{};
  const auto mark = text.find('#');
  if (mark != 3 || !read_hex(text.data(), text.data() + 3, frame.id) || frame.id > 0x7FF) return {};
  const std::size_t digits = text.size() - 4;
  if (digits % 2 != 0 || digits > 16) return {};
  frame.size = static_cast<std::uint8_t>(digits / 2);
  for (std::size_t i = 0; i < frame.size; ++i)
    if (!read_hex(&text[4 + 2 * i], &text[4 + 2 * i] + 2, frame.data[i])) return {};
  return frame;
}

constexpr double max_stamp_s = 9.2e9;  // fits 64 bits of ns

/// A time since 1970 that fits 64 bits of ns. scanf also accepts `nan` and `inf`, which are not
/// times.
bool is_stamp(double time_s) { return time_s >= 0 && time_s < max_stamp_s; }

using Line = std::array<char, 96>;

int print_line(Line& line, const CanFrame& frame, std::int64_t stamp_ns, const char* interface) {
  const std::int64_t us = stamp_ns / 1000;
  int n = std::snprintf(line.data(), line.size(), "(%010lld.%06lld) %.24s %03X#",
                        static_cast<long long>(us / 1'000'000),
                        static_cast<long long>(us % 1'000'000), interface, frame.id);
  for (std::size_t i = 0; i < frame.size && i < sizeof frame.data; ++i)
    n += std::snprintf(line.data() + n, line.size() - static_cast<std::size_t>(n), "%02X",
                       frame.data[i]);
  line[static_cast<std::size_t>(n)] = '\n';
  return n + 1;
}

}  // namespace

std::optional<TraceLine> parse_trace_line(const std::string& line) {
  std::array<char, 32> interface {
  }, frame{};
  TraceLine parsed;
  int end = 0;
  const int read = std::sscanf(line.c_str(), "(%lf) %31s %31s%n", &parsed.time_s, interface.data(),
                               frame.data(), &end);
  if (read != 3 || !is_stamp(parsed.time_s)) return {};
  const auto parsed_frame = parse_frame(frame.data());
  if (!parsed_frame) return {};
  parsed.interface = interface.data();
  parsed.frame = *parsed_frame;
  return parsed;
}

std::string trace_line(const CanFrame& frame, std::int64_t stamp_ns, const std::string& interface) {
  Line line;
  return {line.data(),
          static_cast<std::size_t>(print_line(line, frame, stamp_ns, interface.c_str()))};
}

TraceWriter::TraceWriter(const std::string& file, std::string interface)
    : file_(std::fopen(file.c_str(), "w")), interface_(std::move(interface)) {
  if (!file_)
    throw std::runtime_error("trace \"" + file + "\": " + std::strerror(errno) +
                             "; give a file in a writable folder");
}

void TraceWriter::frame(const CanFrame& frame, std::int64_t stamp_ns, bool) {
  Line line;
  const auto size = static_cast<std::size_t>(print_line(line, frame, stamp_ns, interface_.c_str()));
  if (std::fwrite(line.data(), 1, size, file_.get()) != size) ++lost_;
}

}  // namespace erp
