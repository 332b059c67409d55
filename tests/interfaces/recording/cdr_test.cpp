#include "interfaces/recording/cdr.hpp"

#include <bit>
#include <catch2/catch.hpp>
#include <random>

#include "interfaces/recording/ros2msg.hpp"
#include "tests/interfaces/recording/cdr_writer.hpp"

using namespace recording;

namespace {

TypeDescription type_of(const std::string& text) { return parse_ros2msg("p/msg/T", text); }

std::string decoded(const std::string& schema, const Bytes& message) {
  const TypeDescription type = type_of(schema);
  return to_json(decode_cdr(type, message));
}

}  // namespace

TEST_CASE(
    "numbers are aligned to multiples of their size, counted from the end of the encapsulation") {
  test::CdrWriter cdr;
  cdr.put<std::uint8_t>(1).put<double>(2.5).put<std::uint8_t>(3).put<std::int16_t>(-4);
  CHECK(cdr.bytes.size() == 4 + 8 + 8 + 2 + 2);
  CHECK(decoded("uint8 a\nfloat64 b\nuint8 c\nint16 d\n", cdr.bytes) ==
        R"({"a":1,"b":2.5,"c":3,"d":-4})");
}

TEST_CASE("big-endian and little-endian messages are decoded to equal values") {
  const auto is_little_endian = GENERATE(true, false);
  test::CdrWriter cdr(is_little_endian);
  cdr.put<std::int64_t>(-2).put<float>(0.1f).put<std::uint16_t>(65535).string("hé\"\n");
  CHECK(decoded("int64 a\nfloat32 b\nuint16 c\nstring d\n", cdr.bytes) ==
        "{\"a\":-2,\"b\":0.1,\"c\":65535,\"d\":\"hé\\\"\\u000a\"}");
}

TEST_CASE("minimum and maximum of every primitive type are decoded") {
  test::CdrWriter cdr;
  cdr.put<std::uint8_t>(1)
      .put<std::int8_t>(-128)
      .put<std::uint8_t>(255)
      .put<std::int16_t>(-32768)
      .put<std::uint16_t>(65535)
      .put<std::int32_t>(INT32_MIN)
      .put<std::uint32_t>(UINT32_MAX)
      .put<std::int64_t>(INT64_MIN)
      .put<std::uint64_t>(UINT64_MAX)
      .put<double>(5e-324);
  CHECK(decoded("bool a\nint8 b\nuint8 c\nint16 d\nuint16 e\nint32 f\nuint32 g\nint64 h\nuint64 i\n"
                "float64 j\n",
                cdr.bytes) ==
        R"({"a":true,"b":-128,"c":255,"d":-32768,"e":65535,"f":-2147483648,"g":4294967295,)"
        R"("h":-9223372036854775808,"i":18446744073709551615,"j":5e-324})");
}

TEST_CASE("arrays, sequences and nested structures are decoded") {
  const std::string schema =
      "p/In[2] fixed\nIn[<=3] some\nfloat64[] many\n===\nMSG: p/In\nint8 x\n"
      "string<=4 s\n";
  test::CdrWriter cdr;
  for (const int x : {1, 2}) cdr.put<std::int8_t>(static_cast<std::int8_t>(x)).string("ab");
  cdr.put<std::uint32_t>(1).put<std::int8_t>(3).string("");
  cdr.put<std::uint32_t>(0);
  CHECK(decoded(schema, cdr.bytes) ==
        R"({"fixed":[{"x":1,"s":"ab"},{"x":2,"s":"ab"}],"some":[{"x":3,"s":""}],"many":[]})");
}

TEST_CASE("a string of length 0 without terminating zero is decoded as an empty string") {
  test::CdrWriter cdr;
  cdr.put<std::uint32_t>(0);
  CHECK(decoded("string s\n", cdr.bytes) == R"({"s":""})");
}

TEST_CASE("a message that does not match its type is rejected with the field and the byte") {
  test::CdrWriter cdr;
  std::string schema, what;
  SECTION("a truncated message") {
    schema = "float64 x\n", cdr.put<std::uint32_t>(0), what = "p/msg/T.x: byte 4: is truncated";
  }
  SECTION("a sequence longer than its bound") {
    schema = "uint8[<=2] x\n", cdr.put<std::uint32_t>(3).put<std::uint32_t>(0);
    what = "has 3 elements, at most 2";
  }
  SECTION("a sequence longer than the message") {
    schema = "float64[] x\n", cdr.put<std::uint32_t>(0xffff'ffff),
    what = "more than the message contains";
  }
  SECTION("a string longer than its bound") {
    schema = "string<=2 x\n", cdr.string("abc"), what = "longer than 2 characters";
  }
  SECTION("a string longer than the message") {
    schema = "string x\n", cdr.put<std::uint32_t>(100), what = "longer than the message";
  }
  SECTION("a string without its zero") {
    schema = "string x\n", cdr.put<std::uint32_t>(1).put<std::uint8_t>('a'), what = "closing zero";
  }
  SECTION("a bool of 2") { schema = "bool x\n", cdr.put<std::uint8_t>(2), what = "a bool of 2"; }
  SECTION("surplus bytes") {
    schema = "uint8 x\n", cdr.put<std::uint8_t>(2).put<std::uint64_t>(0),
    what = "bytes more than its type";
  }
  SECTION("another encoding") {
    schema = "uint8 x\n", cdr.put<std::uint8_t>(2), cdr.bytes[1] = std::byte{9},
    what = "encoded as 9";
  }
  SECTION("an empty message") { schema = "uint8 x\n", cdr.bytes.clear(), what = "encapsulation"; }
  CHECK_THROWS_WITH(decoded(schema, cdr.bytes), Catch::Contains(what));
}

TEST_CASE("random bytes are either decoded or rejected with RecordingError") {
  const TypeDescription type = type_of(
      "string name\nIn[] list\nuint8[] raw\nfloat64[3] xyz\n===\nMSG: p/In\nstring<=8 s\nbool[] "
      "b\n");
  std::mt19937 random(5);
  for (int round = 0; round < 20000; ++round) {
    Bytes bytes(random() % 80);
    for (auto& byte : bytes) byte = static_cast<std::byte>(random() % 4 ? random() % 4 : random());
    if (bytes.size() > 1) bytes[0] = std::byte{0}, bytes[1] = static_cast<std::byte>(random() % 2);
    try {
      decode_cdr(type, bytes);
    } catch (const RecordingError&) {
    }
  }
  SUCCEED();
}

TEST_CASE("stamp and sequence are decoded without the fields that follow") {
  const TypeDescription type =
      type_of("string<=32 robot\nint64 stamp_ns\nuint64 sequence\nfloat64[] rest\n");
  test::CdrWriter cdr;
  cdr.string("rig").put<std::int64_t>(-5).put<std::uint64_t>(9);
  const Header header = header_of(type, cdr.bytes);
  CHECK(header.stamp_ns == -5);
  CHECK(header.sequence == 9u);
  CHECK_FALSE(header_of(type_of("uint8 x\n"), Bytes(8)).sequence);
}
