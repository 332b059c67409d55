#include "interfaces/xml/document.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "tests/interfaces/xml/example.hpp"

using example::refusal;

namespace {

std::string place_text(const xml::Place& place) {
  return std::to_string(place.line) + ":" + std::to_string(place.column);
}

xml::Element parsed(const std::string& text) { return xml::parse_document(text, "f.xml"); }

std::string malformed(const std::string& text) {
  return refusal([&] { parsed(text); });
}

}  // namespace

TEST_CASE("every element and attribute has its line and column") {
  const auto root = parsed("<a>\n  <b x=\"1\"\n     y=\"2\"/><c/>\n</a>");
  CHECK(place_text(root.place) == "1:1");
  const auto& b = root.children.at(0);
  CHECK(place_text(b.place) == "2:3");
  CHECK(place_text(b.attributes.at(0).place) == "2:6");
  CHECK(place_text(b.attributes.at(1).place) == "3:6");
  CHECK(place_text(root.children.at(1).place) == "3:13");
}

TEST_CASE("places are correct with CRLF, in text and in values that the parser shortens") {
  const auto root =
      parsed("<a>\r\n words\r\n more <b x=\"&lt;&amp;\r\n&gt;\" y=\"2\"/>\r\n <c/></a>");
  const auto& b = root.children.at(0);
  CHECK(place_text(root.stray_text.at(0).first) == "2:2");
  CHECK(place_text(b.place) == "3:7");
  CHECK(b.attributes.at(0).value == "<&\n>");
  CHECK(place_text(b.attributes.at(1).place) == "4:7");
  CHECK(place_text(root.children.at(1).place) == "5:2");
}

TEST_CASE("columns count characters, not bytes, and do not include a byte order mark") {
  CHECK(place_text(parsed("\xEF\xBB\xBF<a><b/></a>").children.at(0).place) == "1:4");
  CHECK(place_text(parsed("<a n=\"größe\"><b/></a>").children.at(0).place) == "1:14");
}

TEST_CASE("places are correct after a declaration and comments before the root") {
  const auto root = parsed("<?xml version=\"1.0\"?>\n<!-- a\nb -->\n <a><!-- c --><b/></a>");
  CHECK(place_text(root.place) == "4:2");
  CHECK(place_text(root.children.at(0).place) == "4:15");
}

TEST_CASE("text that is not well-formed XML is rejected with the place of the violation") {
  CHECK(malformed("<a>\n <b></a>") == "f.xml:2:5: </a> where <b> is open; write </b> first");
  CHECK_THAT(malformed("<a>\n<b>"), Catch::StartsWith("f.xml:2:1: <b> is never closed"));
  CHECK_THAT(malformed("<a x='1' x='2'/>"), Catch::StartsWith("f.xml:1:10: <a>: x is given twice"));
  CHECK_THAT(malformed("<a x='1'y='2'/>"), Catch::Contains("no space between two attributes"));
  CHECK_THAT(malformed("<a x='<'/>"), Catch::Contains("written &lt;"));
  CHECK_THAT(malformed("<a x/>"), Catch::Contains("x has no value"));
  CHECK_THAT(malformed("<a>&nbsp;</a>"), Catch::StartsWith("f.xml:1:4: a bare \"&\""));
  CHECK_THAT(malformed("<a><!-- x -- y --></a>"), Catch::Contains("\"--\" inside a comment"));
  CHECK_THAT(malformed("<a/><!-- x"), Catch::StartsWith("f.xml:1:5: a comment is never closed"));
  CHECK_THAT(malformed("<a/></b>"), Catch::Contains("</b> has no opening tag"));
  CHECK_THAT(malformed("<a/><b/>"), Catch::StartsWith("f.xml:1:5: a second root element <b>"));
  CHECK_THAT(malformed("<a/>b"), Catch::Contains("text outside the root element: \"b\""));
  CHECK_THAT(malformed("<!DOCTYPE a><a/>"), Catch::Contains("document types"));
  CHECK_THAT(malformed("<a><![CDATA[x]]></a>"), Catch::Contains("CDATA"));
  CHECK_THAT(malformed("<a"), Catch::Contains("<a has no \">\""));
  CHECK_THAT(malformed("<1a/>"), Catch::Contains("expected the name of an element"));
  CHECK_THAT(malformed("no XML"), Catch::StartsWith("f.xml:1:1: text outside the root element"));
}

TEST_CASE("text that is not UTF-8 and control characters are rejected") {
  CHECK_THAT(malformed("<a>\n\xFF</a>"), Catch::StartsWith("f.xml:2:1: is not UTF-8 text"));
  CHECK_THAT(malformed("<a>\xC3</a>"), Catch::Contains("is not UTF-8 text"));
  CHECK_THAT(malformed(std::string("<a/>\0<b/>", 9)),
             Catch::StartsWith("f.xml:1:5: has a control character, code 0"));
}

TEST_CASE("an empty text and a text without an element are rejected") {
  CHECK(malformed("") == "f.xml:1:1: is empty; write the root element");
  CHECK_THAT(malformed(" \n"), Catch::Contains("is empty"));
  CHECK(malformed("<!-- nothing -->") == "f.xml:1:1: contains no element; write the root element");
}

TEST_CASE("nesting of 100000 elements is rejected without exhausting the stack") {
  std::string text;
  for (int i = 0; i < 100000; ++i) text += "<a>";
  for (int i = 0; i < 100000; ++i) text += "</a>";
  CHECK_THAT(malformed(text), Catch::Contains("DEPTH"));
}

TEST_CASE("a missing file, a folder and an empty file are rejected with different messages") {
  const auto folder = std::filesystem::temp_directory_path();
  const auto empty = folder / "erp_empty_document_test.xml";
  std::ofstream(empty).close();
  CHECK(refusal([] { xml::read_document("none.xml"); }) ==
        "none.xml: no such file; check the path, or create the file");
  CHECK_THAT(refusal([&] { xml::read_document(folder.string()); }), Catch::Contains("is a folder"));
  CHECK_THAT(refusal([&] { xml::read_document(empty.string()); }), Catch::Contains("is empty"));
  std::filesystem::remove(empty);
}

TEST_CASE("pipes, devices and oversized files are rejected at once") {
  const auto folder = std::filesystem::temp_directory_path();
  const std::string pipe = folder / ("erp_pipe_" + std::to_string(getpid()));
  REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  CHECK_THAT(refusal([&] { xml::read_document(pipe); }), Catch::Contains("is not a regular file"));
  CHECK_THAT(refusal([] { xml::read_document("/dev/zero"); }),
             Catch::Contains("is not a regular file"));
  std::filesystem::remove(pipe);
  const std::string large = folder / ("erp_large_" + std::to_string(getpid()));
  std::ofstream(large) << "<a/>";
  std::filesystem::resize_file(large, xml::max_document_bytes + 1);
  CHECK_THAT(refusal([&] { xml::read_document(large); }), Catch::Contains("at most 67108864"));
  std::filesystem::remove(large);
}
