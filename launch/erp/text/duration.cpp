#include "launch/erp/text/duration.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>
#include <utility>

namespace launch {

double parse_duration_s(const std::string& text) {
  static constexpr std::array<std::pair<const char*, double>, 5> units{
      {{"", 1}, {"s", 1}, {"ms", 1e-3}, {"min", 60}, {"h", 3600}}};
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  if (end != text.c_str() && std::isfinite(number) && number > 0)
    for (const auto& [unit, factor] : units)
      if (std::string(end) == unit) return number * factor;
  throw std::invalid_argument("\"" + text + "\" is not a duration; write 20s, 500ms, 2min or 1h");
}

std::string to_text_s(double duration_s) {
  char text[48];
  if (duration_s >= 60) {
    const auto rounded_s = static_cast<long>(std::lround(duration_s));
    std::snprintf(text, sizeof text, "%ld min %02ld s", rounded_s / 60, rounded_s % 60);
  } else {
    const int decimals = duration_s < 10 ? 2 : duration_s < 59.95 ? 1 : 0;
    std::snprintf(text, sizeof text, "%.*f s", decimals, duration_s);
  }
  return text;
}

}  // namespace launch
