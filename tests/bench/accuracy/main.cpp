// Compares the simulator with closed-form solutions and prints a table of the errors.
#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <iterator>
#include <sstream>
#include <stdexcept>

#include "tests/bench/accuracy/figure.hpp"

namespace {

using accuracy::Figure, accuracy::Figures;

constexpr auto begin_line =
    "<!-- accuracy: build/release/bench/erp_accuracy --write sim/README.md -->\n";
constexpr auto end_line = "<!-- accuracy ends -->\n";

Figures measure() {
  Figures figures;
  for (const auto test : {accuracy::sphere_wrap, accuracy::quarter_turn, accuracy::muscle_jacobian,
                          accuracy::motor, accuracy::suspended_mass, accuracy::pendulum,
                          accuracy::free_arm, accuracy::dynamics, accuracy::order_and_repetition}) {
    const Figures figures_of_test = test();
    figures.insert(figures.end(), figures_of_test.begin(), figures_of_test.end());
  }
  return figures;
}

std::string text_of(double value, const std::string& unit) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.2g", value);
  return text.data() + (unit.empty() ? "" : " " + unit);
}

std::string table_of(const Figures& figures) {
  std::ostringstream table;
  table << "| test | what | found | allowed |\n|---|---|---|---|\n";
  for (const Figure& f : figures)
    table << "| " << f.test << " | " << f.description << " | " << text_of(f.deviation, f.unit)
          << " | " << text_of(f.limit, f.unit) << " |\n";
  return table.str();
}

/// Prints the figures that exceed their limits; NaN exceeds every limit.
bool all_within_limits(const Figures& figures) {
  bool within_limits = true;
  for (const Figure& f : figures) {
    if (f.deviation <= f.limit) continue;
    std::cerr << "erp_accuracy: test " << f.test << " exceeds its limit: " << f.description << '\n';
    within_limits = false;
  }
  return within_limits;
}

/// The text before and after a table.
struct Frame {
  std::string before, after;
};

Frame frame_of(const std::string& file) {
  std::ifstream in(file);
  if (!in) throw std::invalid_argument("cannot read " + file);
  const std::string text(std::istreambuf_iterator<char>(in), {});
  const auto begin = text.find(begin_line), end = text.find(end_line);
  if (begin == std::string::npos || end == std::string::npos || end < begin)
    throw std::invalid_argument(file + " lacks the marker lines\n" + begin_line + end_line);
  return {text.substr(0, begin) + begin_line, text.substr(end)};
}

void write(const std::string& file, const std::string& text) {
  std::ofstream out(file);
  out << text << std::flush;
  if (!out) throw std::runtime_error("cannot write " + file);
}

int run(const std::string& file) {
  const Frame frame = file.empty() ? Frame{} : frame_of(file);
  const Figures figures = measure();
  const std::string table = table_of(figures);
  std::cout << table;
  if (!file.empty()) write(file, frame.before + table + frame.after);
  return all_within_limits(figures) ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Compares the simulator with closed-form solutions.", "erp_accuracy");
  std::string file;
  app.add_option("--write", file,
                 "write the table between the two accuracy marker lines of this file")
      ->type_name("FILE");
  app.footer(
      "Exit codes: 0 all errors within their limits, 1 a limit is exceeded or failed, 2 bad usage "
      "or input.");
  try {
    app.parse(argc, argv);
    return run(file);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const std::invalid_argument& error) {
    std::cerr << "erp_accuracy: " << error.what() << '\n';
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "erp_accuracy: " << error.what() << '\n';
    return 1;
  }
}
