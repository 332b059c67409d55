#include "launch/erp/screen.hpp"

#include <catch2/catch.hpp>
#include <cstdio>
#include <memory>
#include <string>

namespace {

/// A file in memory's stead, that is no terminal.
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

TEST_CASE("without a terminal only changes are written, as plain lines") {
  const Capture capture;
  launch::Screen screen(capture.file);
  CHECK_FALSE(screen.is_terminal());
  screen.show(status("starting", "starting"));
  screen.show(status("starting", "starting"));
  screen.show(status("active", "starting"));
  screen.say(1.5, "done");
  CHECK(capture.text() ==
        "    0.00  plant: starting\n"
        "    0.00  sim: starting\n"
        "    0.00  plant: active\n"
        "    1.50  done\n");
}
