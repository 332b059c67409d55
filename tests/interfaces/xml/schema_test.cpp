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
  const bool is_valid_by_schema = valid_by_schema(schema, {file}).contains(file);
  const std::string errors = example::refusal_of<T>(text);
  INFO(text << "\n" << errors);
  CHECK(is_valid_by_schema == errors.empty());
  std::filesystem::remove(schema);
  std::filesystem::remove(file);
  return is_valid_by_schema && errors.empty();
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
  const auto accepts = [](const std::string& attribute, const std::string& text) {
    return both_accept<Numbers>("<numbers " + attribute + "=\"" + text + "\"/>");
  };
  for (const char* valid : {"1", "-1.5", " 1 ", "+1", ".5", "5.", "1e5", "1.E+5", "-0"})
    CHECK(accepts("x", valid));
  for (const char* invalid :
       {"", "1e", ".", "e5", "NaN", "INF", "-INF", "1 2", "0x1", "1e999", "1d"})
    CHECK_FALSE(accepts("x", invalid));
  CHECK_FALSE(accepts("open", "0"));
  CHECK(accepts("closed", "0"));
  CHECK_FALSE(accepts("closed", "1.0000001"));
  for (const char* valid : {"0", " -7 ", "+7", "007"}) CHECK(accepts("i", valid));
  for (const char* invalid : {"1.0", "", "3000000000", "1e3"}) CHECK_FALSE(accepts("i", invalid));
  CHECK(accepts("large", "1000000000"));
  CHECK_FALSE(accepts("large", "1000000001"));
  CHECK_FALSE(accepts("seed", "-1"));
  for (const char* invalid : {"1", "TRUE", "", "yes"}) CHECK_FALSE(accepts("b", invalid));
  CHECK(accepts("b", " true "));
  CHECK(accepts("s", ""));
  CHECK(accepts("v", " 1  2\n3 "));
  CHECK(accepts("list", ""));
  for (const char* invalid : {"1 2", "1 2 3 4", "1 2 -3", ""}) CHECK_FALSE(accepts("v", invalid));
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
