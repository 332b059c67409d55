#include "hal/can/trace.hpp"

#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>

#include "tests/hal/can/link_both.hpp"
#include "tests/hal/can/pair.hpp"

using namespace can_test;

namespace {

std::string temporary_path(const std::string& name) {
  return (std::filesystem::temp_directory_path() / (std::to_string(getpid()) + name)).string();
}

}  // namespace

TEST_CASE("a trace line in candump's format is unchanged by parse and write") {
  const erp::CanFrame frame{0x12A, 4, {0xDE, 0xAD, 0xBE, 0x0F}};
  const auto line = erp::trace_line(frame, 1'436'509'053'850'870'321, "can0");
  CHECK(line == "(1436509053.850870) can0 12A#DEADBE0F\n");
  const auto read = erp::parse_trace_line(line);
  REQUIRE(read);
  CHECK(read->time_s == Approx(1436509053.85087).epsilon(1e-12));
  CHECK(read->interface == "can0");
  CHECK(same(read->frame, frame));
  CHECK(erp::parse_trace_line("(1.5) left 000#")->frame.size == 0);
}

TEST_CASE("a line with another kind of frame is not parsed") {
  for (const char* line :
       {"", "# comment", "(1.0) can0", "(x) can0 123#00", "(1.0) can0 1F334455#1122",
        "(1.0) can0 123#R", "(1.0) can0 123##1AABB", "(1.0) can0 123#1",
        "(1.0) can0 123#001122334455667788", "(1.0) can0 FFF#00", "(1.0) can0 12#00",
        "(1.0) can0 123#GG", "(1.0) can0 20000040#00", "(nan) can0 123#00", "(inf) can0 123#00",
        "(-1.0) can0 123#00", "(1e10) can0 123#00"})
    CHECK_FALSE(erp::parse_trace_line(line));
}

TEST_CASE("frames that a full disk does not take are counted") {
  erp::TraceWriter trace("/dev/full", "can0");
  for (int k = 0; k < 1000; ++k) trace.frame(erp::CanFrame{}, k, false);
  CHECK(trace.lost() > 0);
}

TEST_CASE("the error of a trace that cannot be written or read gives the reason") {
  CHECK_THROWS_WITH(erp::TraceWriter("/nowhere/trace.log", "can0"),
                    Catch::Contains("trace \"/nowhere/trace.log\": No such file"));
  CHECK_THROWS_WITH(erp::open_bus("trace:/nowhere/trace.log"), Catch::Contains("cannot read it"));
  CHECK_THROWS_WITH(erp::open_bus("trace:/dev/null"),
                    Catch::Contains("contains no frame of an ECU"));
}

TEST_CASE("a trace contains the sent and received frames of a bus and replays the received ones") {
  const auto where = free_udp_bus(), file = temporary_path("trace.log");
  Pair pair;
  std::vector<erp::EcuFrame> original;
  {
    const auto host = erp::open_bus(where), robot = erp::open_bus(where);
    erp::TraceWriter trace(file, "left");
    host->record(&trace);
    std::array<erp::CanFrame, 64> frames;
    for (int tick = 0; tick < 40; ++tick) {
      robot->send(pair.report());
      while (const auto count = host->receive(frames, 0.5)) {
        pair.receive(std::span(frames).first(count));
        if (pair.gateway.frame().sequence == std::uint64_t(tick + 1)) break;
      }
      original.push_back(pair.gateway.frame());
      host->send(pair.gateway.commands(command_for(pair.robot, std::uint64_t(tick + 1), 0, 0)));
      CHECK(host->receive(frames, 0.01) == 0);  // processes own frames, returns none
    }
  }
  std::ifstream lines(file);
  int sent = 0, received = 0;
  for (std::string line; std::getline(lines, line);) {
    const auto read = erp::parse_trace_line(line);
    REQUIRE(read);
    ++(frame_function_of(&read->frame) == FRAME_COMMAND ? sent : received);
  }
  CHECK(sent == 40 * 3);
  CHECK(received >= 40 * 9);

  erp::Gateway replayed(pair.robot);
  const auto bus = erp::open_bus("trace:" + file);
  std::array<erp::CanFrame, 64> frames;
  std::size_t ticks = 0;
  while (ticks < original.size()) {
    const auto count = bus->receive(frames, 2);
    for (std::size_t i = 0; i < count; ++i)
      if (replayed.receive(frames[i]) == erp::FrameResult::tick)
        CHECK(difference(replayed.frame(), original[ticks++]) == "");
  }
  CHECK(replayed.counters().lost == 0);
  std::filesystem::remove(file);
}
