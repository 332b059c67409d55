#include "launch/erp/run/screen.hpp"

#include <poll.h>
#include <pty.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cstdio>
#include <memory>
#include <string>

namespace {

/// A temporary file, which is not a terminal.
struct Capture {
  std::FILE* file = std::tmpfile();
  ~Capture() { std::fclose(file); }
  std::string text() const {
    std::rewind(file);
    std::string all;
    for (int c = std::fgetc(file); c != EOF; c = std::fgetc(file)) all += static_cast<char>(c);
    return all;
  }
};

launch::Status status(const std::string& plant, const std::string& sim) {
  return {.rows = {{.name = "plant", .state = plant}, {.name = "sim", .state = sim}}};
}

}  // namespace

TEST_CASE("without a terminal, changes are written as plain lines") {
  const Capture capture;
  launch::Screen screen(capture.file);
  CHECK_FALSE(screen.is_terminal());
  screen.show(status("starting", "starting"));
  screen.show(status("starting", "starting"));
  screen.show(status("active", "starting"));
  screen.print(1.5, "done");
  CHECK(capture.text() ==
        "    0.00  plant: starting\n"
        "    0.00  sim: starting\n"
        "    0.00  plant: active\n"
        "    1.50  done\n");
}

TEST_CASE("on a terminal the last table and the lines printed after it remain") {
  int master = -1, slave = -1;
  REQUIRE(openpty(&master, &slave, nullptr, nullptr, nullptr) == 0);
  std::FILE* terminal = fdopen(slave, "w");
  {
    launch::Screen screen(terminal);
    CHECK(screen.is_terminal());
    screen.show(status("active", "active"));
    screen.show(status("ended", "ended"));
  }
  std::fprintf(terminal, "the summary\n");
  std::fflush(terminal);
  std::string text;  // a terminal may return the text in parts
  for (pollfd ready{master, POLLIN, 0};
       text.find("the summary") == text.npos && poll(&ready, 1, 2000) > 0;) {
    char part[4096];
    const auto length = read(master, part, sizeof part);
    if (length <= 0) break;
    text.append(part, static_cast<std::size_t>(length));
  }
  std::fclose(terminal), close(master);
  const auto last_erased = text.rfind("\033[J"), summary = text.find("the summary");
  REQUIRE(summary != text.npos);
  CHECK(last_erased < text.rfind("ended"));
  CHECK(text.rfind("ended") < summary);
}
