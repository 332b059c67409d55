#include "sim/learner/learner.hpp"

#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "interfaces/recording/csv.hpp"

namespace sim::learner {
namespace {

namespace fs = std::filesystem;

void replace(const fs::path& file, const std::string& text) {
  const fs::path fresh = file.string() + ".new";
  {
    std::ofstream out(fresh, std::ios::binary);
    if (!(out << text << std::flush))
      throw std::invalid_argument(fresh.string() + ": cannot be written");
  }
  fs::rename(fresh, file);
}

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::string heading(const std::vector<Metric>& metrics) {
  std::string line = "round";
  for (const Metric& metric : metrics) line += "," + recording::csv_cell(metric.name);
  return line + "\n";
}

std::string row(int round, const std::vector<Metric>& metrics) {
  std::string line = std::to_string(round);
  for (const Metric& metric : metrics) line += "," + recording::csv_number(metric.value);
  return line + "\n";
}

/// The heading and the rows of so many rounds; what was written of a later one is dropped.
std::string first_rows(const std::string& curve, int rounds) {
  std::istringstream lines(curve);
  std::string kept, line;
  for (int k = 0; k <= rounds + 1 && std::getline(lines, line); ++k) kept += line + "\n";
  return kept;
}

}  // namespace

void learn(Learner& learner, const Course& course) {
  const fs::path state = fs::path(course.folder) / "state.xml";
  const fs::path curve = fs::path(course.folder) / "curve.csv";
  fs::create_directories(course.folder);
  if (fs::exists(state) != course.resume)
    throw std::invalid_argument(
        course.folder + (course.resume ? ": holds no run that could be resumed"
                                       : ": holds a run: resume it, or name another folder"));
  if (course.resume) learner.restore(text_of(state), state.string());
  std::string told = course.resume ? first_rows(text_of(curve), learner.rounds())
                                   : heading(learner.metrics()) + row(0, learner.metrics());
  const auto keep = [&] { replace(curve, told), replace(state, learner.state()); };
  for (keep(); learner.rounds() < course.rounds;) {
    learner.round(course.threads);
    told += row(learner.rounds(), learner.metrics());
    keep();
    if (!course.told(learner)) return;
  }
}

}  // namespace sim::learner
