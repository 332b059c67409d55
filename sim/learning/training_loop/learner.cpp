#include "sim/learning/training_loop/learner.hpp"

#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "interfaces/recording/csv.hpp"
#include "sim/learning/training_loop/keep.hpp"

namespace sim::training_loop {
namespace {

namespace fs = std::filesystem;

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

/// Where a course is kept.
class Folder {
 public:
  explicit Folder(const std::string& path) : path_(path) {}

  std::string state_file() const { return (path_ / "state.xml").string(); }
  /// What was kept of a run to be resumed.
  std::string state(bool resume) const {
    if (fs::exists(state_file()) != resume)
      throw std::invalid_argument(path_.string() +
                                  (resume ? ": holds no run that could be resumed"
                                          : ": holds a run: resume it, or name another folder"));
    return resume ? text_of(state_file()) : "";
  }
  void begin(const Learner& learner, bool resumed) {
    fs::create_directories(path_);
    curve_ = resumed ? first_rows(text_of(curve_file()), learner.rounds())
                     : heading(learner.metrics()) + row(0, learner.metrics());
    keep(curve_file(), curve_), keep(state_file(), learner.state());
  }
  void add(const Learner& learner) {
    curve_ += row(learner.rounds(), learner.metrics());
    keep(curve_file(), curve_), keep(state_file(), learner.state());
  }

 private:
  std::string curve_file() const { return (path_ / "curve.csv").string(); }

  fs::path path_;
  std::string curve_;
};

}  // namespace

void learn(Learner& learner, const Course& course, const Pool& pool) {
  Folder folder(course.folder);
  const std::string kept = pool.from_first(pool.first() ? folder.state(course.resume) : "");
  if (course.resume) learner.restore(kept, folder.state_file());
  if (pool.first()) folder.begin(learner, course.resume);
  while (learner.rounds() < course.rounds && !learner.done()) {
    learner.round(pool);
    if (pool.first()) folder.add(learner);
    const bool on = !pool.first() || course.told(learner);
    if (pool.from_first(on ? "on" : "") != "on") return;
  }
}

}  // namespace sim::training_loop
