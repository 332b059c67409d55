#include "launch/erp/gap/svg.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "interfaces/xml/writer.hpp"

namespace launch::gap::svg {
namespace {

std::string text(double x, double y, const std::string& words, const char* anchor = "start",
                 const char* attributes = "") {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" {}>{}</text>\n", x, y,
                     anchor, attributes, xml::escaped(words));
}

std::string rect(double x, double y, double w, double h, const std::string& style) {
  return fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" {}/>\n", x,
                     y, std::max(0.0, w), h, style);
}

std::string opening_tag(int width, int height) {
  return fmt::format("<svg viewBox=\"0 0 {0} {1}\" width=\"{0}\" height=\"{1}\" role=\"img\">\n",
                     width, height);
}

/// Colour from white (0) to dark blue (1).
std::string shade(double share) {
  const double s = std::clamp(share, 0.0, 1.0);
  return fmt::format("rgb({:.0f},{:.0f},{:.0f})", 255 - 225 * s, 255 - 165 * s, 255 - 95 * s);
}

struct Range {
  double low = 1e300, high = -1e300;
  void include(double v) {
    if (!std::isnan(v)) low = std::min(low, v), high = std::max(high, v);
  }
  void widen() {
    if (low > high) low = 0, high = 1;
    const double margin = std::max(0.05 * (high - low), 1e-12);
    low -= margin, high += margin;
  }
  double fraction(double v) const { return (v - low) / (high - low); }
};

/// About four round numbers within the range.
std::vector<double> ticks(const Range& range) {
  const double rough = (range.high - range.low) / 4;
  const double power = std::pow(10, std::floor(std::log10(rough)));
  const double step = power * (rough / power < 1.5 ? 1 : rough / power < 3.5 ? 2 : 5);
  std::vector<double> all;
  for (double t = std::ceil(range.low / step) * step; t < range.high; t += step)
    all.push_back(std::abs(t) < step / 1e6 ? 0 : t);
  return all;
}

}  // namespace

std::string plot(const Axes& axes, const std::vector<Line>& lines) {
  constexpr double left = 64, right = 16, top = 44, bottom = 40, legend_y = 34;
  const double w = axes.width - left - right, h = axes.height - top - bottom;
  Range x, y;
  for (const Line& line : lines) {
    for (const double v : line.x) x.include(v);
    for (const double v : line.y) y.include(v);
  }
  if (axes.band > 0) y.include(axes.band), y.include(-axes.band);
  if (x.low > x.high) x = {0, 1};
  y.widen();
  const auto px = [&](double v) { return left + w * x.fraction(v); };
  const auto py = [&](double v) { return top + h * (1 - y.fraction(v)); };
  std::string svg =
      opening_tag(axes.width, axes.height) + text(left, 16, axes.title, "start", "class=\"t\"");
  if (axes.band > 0)
    svg += rect(left, py(axes.band), w, py(-axes.band) - py(axes.band), "class=\"band\"");
  for (const double t : ticks(y))
    svg += fmt::format("<path d=\"M{:.1f} {:.1f}h{:.1f}\" class=\"grid\"/>", left, py(t), w) +
           text(left - 6, py(t) + 4, fmt::format("{:.3g}", t), "end");
  for (const double t : ticks(x))
    svg += text(px(t), axes.height - bottom + 16, fmt::format("{:.4g}", t), "middle");
  svg += text(left + w / 2, axes.height - 6, axes.x_label, "middle");
  svg += text(axes.width - right, 16, axes.y_label, "end");
  double legend = left + w;
  // The last line is drawn first and is the widest: coinciding lines all remain visible.
  for (auto line = lines.rbegin(); line != lines.rend(); ++line) {
    const double line_width = 1.4 + 1.2 * double(lines.rend() - line - 1);
    std::string path;
    bool drawn = false;
    for (std::size_t k = 0; k < line->x.size(); ++k) {
      if (std::isnan(line->y[k])) {
        drawn = false;
        continue;
      }
      path += fmt::format("{}{:.1f} {:.1f}", drawn ? "L" : "M", px(line->x[k]), py(line->y[k]));
      drawn = true;
    }
    svg += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{:.1f}\"/>\n",
                       path, line->colour, line_width);
    svg += text(legend, legend_y, line->label, "end",
                fmt::format("fill=\"{}\"", line->colour).c_str());
    legend -= 9.0 * double(line->label.size()) + 12;
  }
  return svg + "</svg>\n";
}

std::string bars(const std::string& title, const std::vector<Bar>& all, double max_value) {
  constexpr int width = 860, left = 330, right = 150, row = 22, top = 28;
  const double w = width - left - right;
  const auto px = [&](double v) { return left + w * std::clamp(v / max_value, 0.0, 1.0); };
  std::string svg = opening_tag(width, top + row * static_cast<int>(all.size()) + 8) +
                    text(0, 16, title, "start", "class=\"t\"");
  double y = top;
  for (const Bar& bar : all) {
    svg += text(left - 8, y + 14, bar.label, "end");
    svg += rect(left, y + 4, px(bar.value) - left, row - 8,
                bar.strong ? "class=\"strong\"" : "class=\"weak\"");
    if (bar.low < bar.high)
      svg += fmt::format("<path d=\"M{:.1f} {:.1f}H{:.1f}\" class=\"whisker\"/>", px(bar.low),
                         y + row / 2.0, px(bar.high));
    svg += text(width - right + 8, y + 14, bar.note);
    y += row;
  }
  return svg + "</svg>\n";
}

std::string matrix(const std::string& title, const std::vector<std::string>& rows,
                   const std::vector<std::string>& columns,
                   const std::vector<std::vector<double>>& cells) {
  constexpr int left = 330, cell_w = 54, cell_h = 22, top = 150;
  const int width = left + cell_w * static_cast<int>(columns.size()) + 90;
  std::string svg = opening_tag(width, top + cell_h * static_cast<int>(rows.size()) + 8) +
                    text(0, 16, title, "start", "class=\"t\"");
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const double x = left + cell_w * (double(c) + 0.5);
    svg += text(x, top - 8, columns[c], "start",
                fmt::format("transform=\"rotate(-50 {:.1f} {})\"", x, top - 8).c_str());
  }
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const double y = top + cell_h * double(r);
    svg += text(left - 8, y + 15, rows[r], "end");
    for (std::size_t c = 0; c < columns.size() && c < cells[r].size(); ++c) {
      svg += rect(left + cell_w * double(c), y, cell_w - 2, cell_h - 2,
                  fmt::format("fill=\"{}\" stroke=\"#ccc\"", shade(cells[r][c])));
      if (cells[r][c] >= 0.01)
        svg += text(left + cell_w * (double(c) + 0.5) - 1, y + 15,
                    fmt::format("{:.0f}", 100 * cells[r][c]), "middle",
                    cells[r][c] > 0.55 ? "fill=\"#fff\"" : "");
    }
  }
  return svg + "</svg>\n";
}

std::string chain(const std::string& title, const std::vector<std::string>& boxes,
                  const std::vector<double>& shares, const std::vector<std::string>& notes) {
  constexpr int step = 98, box = 82, height = 96;
  std::string svg = opening_tag(step * static_cast<int>(boxes.size()) + 10, height) +
                    text(0, 16, title, "start", "class=\"t\"");
  for (std::size_t k = 0; k < boxes.size(); ++k) {
    const double x = 4 + step * double(k);
    svg +=
        rect(x, 30, box, 52, fmt::format("rx=\"5\" fill=\"{}\" stroke=\"#888\"", shade(shares[k])));
    const char* ink = shares[k] > 0.55 ? "fill=\"#fff\"" : "";
    svg += text(x + box / 2.0, 52, boxes[k], "middle", ink);
    svg += text(x + box / 2.0, 70, notes[k], "middle", ink);
    if (k + 1 < boxes.size()) svg += text(x + box + 8, 60, "→", "middle");
  }
  return svg + "</svg>\n";
}

}  // namespace launch::gap::svg
