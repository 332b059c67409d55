#include "interfaces/xml/schema.hpp"

#include <catch2/catch.hpp>
#include <cstdint>
#include <filesystem>

#include "tests/interfaces/xml/example.hpp"
#include "tests/interfaces/xml/xmllint.hpp"

namespace {

/// Checks that the XSD of `T` and the reader agree on a text; returns whether they accept it.
template <class T>
bool both_accept(const std::string& text) {
  const std::string schema = temporary("schema.xsd", xml::schema<T>());
  const std::string file = temporary("text.xml", text);
  const bool by_schema = valid_by_schema(schema, {file}).contains(file);
  const std::string refused = example::refusal_of<T>(text);
  INFO(text << "\n" << refused);
  CHECK(by_schema == refused.empty());
  std::filesystem::remove(schema);
  std::filesystem::remove(file);
  return by_schema && refused.empty();
}

/// Values of each type, for comparing what reader and XSD accept.
struct Numbers {
  static constexpr auto element = "numbers";
  double x = 0;
  std::optional<double> open, closed;
  int i = 0;
  int large = 0;
  std::uint64_t seed = 0;
  bool b = false;
  std::string s;
  xml::Vec3 v{0, 0, 0};
  std::vector<double> list;
  void visit(auto& visitor) {
    visitor("x", x);
    visitor("open", open, xml::Range{0, 1, true, true});
    visitor("closed", closed, xml::Range{0, 1});
    visitor("i", i);
    visitor("large", large, xml::Range{0, 1e9});
    visitor("seed", seed);
    visitor("b", b);
    visitor("s", s);
    visitor("v", v, xml::at_least_zero);
    visitor("list", list);
  }
};

/// A struct that XSD 1.0 cannot express.
struct Mixture {
  static constexpr auto element = "mixture";
  example::Wheel wheel;
  std::vector<example::Bell> bells;
  void visit(auto& v) { v.child(wheel), v.list(bells); }
};

}  // namespace

TEST_CASE("reader and XSD accept the same values") {
  const auto with = [](const std::string& attribute, const std::string& text) {
    return both_accept<Numbers>("<numbers " + attribute + "=\"" + text + "\"/>");
  };
  for (const char* good : {"1", "-1.5", " 1 ", "+1", ".5", "5.", "1e5", "1.E+5", "-0"})
    CHECK(with("x", good));
  for (const char* bad : {"", "1e", ".", "e5", "NaN", "INF", "-INF", "1 2", "0x1", "1e999", "1d"})
    CHECK_FALSE(with("x", bad));
  CHECK_FALSE(with("open", "0"));
  CHECK(with("closed", "0"));
  CHECK_FALSE(with("closed", "1.0000001"));
  for (const char* good : {"0", " -7 ", "+7", "007"}) CHECK(with("i", good));
  for (const char* bad : {"1.0", "", "3000000000", "1e3"}) CHECK_FALSE(with("i", bad));
  CHECK(with("large", "1000000000"));
  CHECK_FALSE(with("large", "1000000001"));
  CHECK_FALSE(with("seed", "-1"));
  for (const char* bad : {"1", "TRUE", "", "yes"}) CHECK_FALSE(with("b", bad));
  CHECK(with("b", " true "));
  CHECK(with("s", ""));
  CHECK(with("v", " 1  2\n3 "));
  CHECK(with("list", ""));
  for (const char* bad : {"1 2", "1 2 3 4", "1 2 -3", ""}) CHECK_FALSE(with("v", bad));
}

TEST_CASE("reader and XSD accept the same children") {
  CHECK(both_accept<example::Cart>("<cart><bell/><wheel/></cart>"));
  CHECK_FALSE(both_accept<example::Cart>("<cart><bell/></cart>"));
  CHECK_FALSE(both_accept<example::Cart>("<cart><wheel/><wheel/></cart>"));
  CHECK_FALSE(both_accept<example::Cart>("<cart><wheel/>text</cart>"));
  CHECK(both_accept<example::Row>("<row><bell/><wheel/><bell/></row>"));
  CHECK(both_accept<example::Row>("<row/>"));
  CHECK_FALSE(both_accept<example::Row>("<row><track/></row>"));
}

TEST_CASE("schema throws for a struct that mixes lists and single children") {
  CHECK_THROWS_AS(xml::schema<Mixture>(), std::logic_error);
}
