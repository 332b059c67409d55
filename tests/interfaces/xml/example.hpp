#pragma once
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "interfaces/xml/xml.hpp"

/// Example structs for the tests; together they use every function of `visit`.
namespace example {

enum class Mode { slow, fast };

struct Track {
  static constexpr auto element = "track";
  xml::Place place;
  std::string name;
  int step = 1;
  void visit(auto& v) {
    v.required("name", name);
    v("step", step, xml::Range{1, 10});
  }
};

/// Parameters of a component, without an element name.
struct Params {
  double gain_per_s = 1;
  Mode mode = Mode::fast;
  bool enabled = false;
  xml::Vec3 offset_m{0, 0, 0};
  std::optional<double> limit_N;
  std::vector<std::string> names;
  float factor = 0.5f;
  std::vector<Track> tracks;
  void visit(auto& v) {
    v.required("gain_per_s", gain_per_s, xml::positive);
    v("mode", mode);
    v("enabled", enabled);
    v("offset_m", offset_m);
    v("limit_N", limit_N, xml::at_least_zero);
    v("names", names);
    v("factor", factor);
    v.list(tracks);
  }
};

struct Wheel {
  static constexpr auto element = "wheel";
  xml::Place place;
  double radius_m = 0.1;
  void visit(auto& v) { v("radius_m", radius_m, xml::positive); }
};

struct Bell {
  static constexpr auto element = "bell";
  std::string tone;
  void visit(auto& v) { v("tone", tone); }
};

/// A struct with single children.
struct Cart {
  static constexpr auto element = "cart";
  xml::Place place;
  Wheel wheel;
  std::optional<Bell> bell;
  void visit(auto& v) {
    v.child(wheel);
    v.optional_child(bell);
  }
};

/// A struct with a list of several kinds, which keeps its order.
struct Row {
  static constexpr auto element = "row";
  std::vector<std::variant<Wheel, Bell>> things;
  void visit(auto& v) { v.list(things); }
};

/// The message of the xml::Errors that a call throws; "" if it throws none.
template <class Call>
std::string refusal(Call&& call) {
  try {
    call();
  } catch (const xml::Errors& errors) {
    return errors.what();
  }
  return "";
}

template <class T>
std::string refusal_of(const std::string& text) {
  return refusal([&] { xml::parse<T>(text, "f.xml"); });
}

inline Params params_of(const std::string& text) {
  Params params;
  xml::read_into(params, xml::parse_document(text, "f.xml"), "tracker");
  return params;
}

inline std::string refusal_of_params(const std::string& text) {
  return refusal([&] { params_of(text); });
}

}  // namespace example

template <>
struct xml::Names<example::Mode> {
  static constexpr auto list = std::to_array<std::pair<const char*, example::Mode>>(
      {{"slow", example::Mode::slow}, {"fast", example::Mode::fast}});
};
