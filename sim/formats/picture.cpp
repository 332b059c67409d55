#include <algorithm>
#include <array>

#include "interfaces/xml/tree.hpp"
#include "sim/formats/formats.hpp"
#include "sim/formats/scene.hpp"

namespace formats {
namespace {

using sim::Vec3;
using xml::Tree;

constexpr double height_px = 900, margin_px = 30, title_px = 40, gap_px = 60;  // chosen
constexpr double edge_px = 1.5, min_width_px = 1.5;  // chosen: widths of lines
constexpr double bar_m = 0.1;                        // length of the scale bar
constexpr auto ink = "#333333";

/// A view direction: world axes that point right, up, and towards the viewer.
struct View {
  const char* title;
  Vec3 right, up, towards;
};
const std::array views{View{"from the front", Vec3::UnitY(), Vec3::UnitZ(), Vec3::UnitX()},
                       View{"from its right", Vec3::UnitX(), Vec3::UnitZ(), -Vec3::UnitY()}};

/// Extent of a view in metres.
struct Frame {
  double left = 1e9, right = -1e9, bottom = 1e9, top = -1e9;
};

Frame frame_of(const std::vector<Stroke>& strokes, const View& view) {
  Frame f;
  for (const Stroke& stroke : strokes)
    for (const Vec3& point : stroke.points) {
      const double x = view.right.dot(point), y = view.up.dot(point), r = stroke.width_m / 2;
      f.left = std::min(f.left, x - r), f.right = std::max(f.right, x + r);
      f.bottom = std::min(f.bottom, y - r), f.top = std::max(f.top, y + r);
    }
  return f;
}

double nearness(const Stroke& stroke, const View& view) {
  double sum = 0;
  for (const Vec3& point : stroke.points) sum += view.towards.dot(point);
  return sum / static_cast<double>(stroke.points.size());
}

/// Draws from far to near, and muscles last.
std::vector<Stroke> sorted(std::vector<Stroke> strokes, const View& view) {
  std::ranges::stable_sort(strokes, [&](const Stroke& a, const Stroke& b) {
    return a.layer != b.layer ? a.layer < b.layer : nearness(a, view) < nearness(b, view);
  });
  return strokes;
}

class Picture {
 public:
  Picture(const std::vector<Stroke>& strokes, const std::string& name) {
    std::array<Frame, views.size()> frames;
    double tallest = 0;
    for (std::size_t k = 0; k < views.size(); ++k) {
      frames[k] = frame_of(strokes, views[k]);
      tallest = std::max(tallest, frames[k].top - frames[k].bottom);
    }
    px_per_m_ = (height_px - 2 * margin_px - title_px) / tallest;
    double x = margin_px;
    for (std::size_t k = 0; k < views.size(); ++k) {
      draw(sorted(strokes, views[k]), views[k], frames[k], x);
      x += (frames[k].right - frames[k].left) * px_per_m_ + gap_px;
    }
    finish(name, x - gap_px + margin_px);
  }
  std::string text() const { return xml::write_tree(root_); }

 private:
  void draw(const std::vector<Stroke>& strokes, const View& view, const Frame& frame, double x_px) {
    add_text(x_px, 22, view.title, "start");
    view_ = &view;
    left_px_ = x_px - frame.left * px_per_m_;
    below_px_ = height_px - margin_px - title_px / 2 + frame.bottom * px_per_m_;
    for (const Stroke& stroke : strokes)
      if (stroke.points.size() == 1) circle(stroke);
      else line(stroke);
  }
  double x_of(const Vec3& point) const { return left_px_ + view_->right.dot(point) * px_per_m_; }
  double y_of(const Vec3& point) const { return below_px_ - view_->up.dot(point) * px_per_m_; }

  void circle(const Stroke& stroke) {
    Tree& element = root_.add("circle")
                        .set("cx", x_of(stroke.points[0]))
                        .set("cy", y_of(stroke.points[0]))
                        .set("r", stroke.width_m / 2 * px_per_m_)
                        .set("fill", stroke.fill)
                        .set("stroke", stroke.edge ? stroke.edge : stroke.fill)
                        .set("stroke-width", edge_px);
    element.add("title", stroke.title);
  }

  /// The edge is drawn as a wider line below.
  void line(const Stroke& stroke) {
    const double width = std::max(min_width_px, stroke.width_m * px_per_m_);
    if (stroke.edge) trace(stroke, stroke.edge, width + edge_px);
    trace(stroke, stroke.fill, stroke.edge ? width - edge_px : width);
  }

  void trace(const Stroke& stroke, const char* colour, double width_px) {
    std::string points;
    for (const Vec3& point : stroke.points)
      points += std::to_string(x_of(point)) + "," + std::to_string(y_of(point)) + " ";
    Tree& element = root_.add("polyline")
                        .set("points", points)
                        .set("stroke", colour)
                        .set("stroke-width", width_px)
                        .set("stroke-linecap", "round")
                        .set("stroke-linejoin", "round")
                        .set("fill", "none");
    element.add("title", stroke.title);
  }

  Tree& add_text(double x, double y, const std::string& text, const char* anchor) {
    return root_.add("text", text)
        .set("x", x)
        .set("y", y)
        .set("fill", ink)
        .set("font-family", "sans-serif")
        .set("font-size", 15)
        .set("text-anchor", anchor);
  }

  /// Adds name and scale bar, and sets the size of the picture.
  void finish(const std::string& name, double width) {
    const double y = height_px - 12, x = width - margin_px, length = bar_m * px_per_m_;
    add_text(margin_px, y, name, "start").set("font-weight", "bold");
    add_text(x - length / 2, y - 6, "0.1 m", "middle");
    root_.add("line")
        .set("x1", x - length)
        .set("x2", x)
        .set("y1", y)
        .set("y2", y)
        .set("stroke", ink)
        .set("stroke-width", 3);
    root_.set("xmlns", "http://www.w3.org/2000/svg").set("width", width).set("height", height_px);
  }

  double px_per_m_ = 1, left_px_ = 0, below_px_ = 0;
  const View* view_ = nullptr;
  Tree root_{"svg"};
};

}  // namespace

std::string to_svg(const erp::Robot& robot) {
  return Picture(strokes_of(robot), robot.name).text();
}

}  // namespace formats
