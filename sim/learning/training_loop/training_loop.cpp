#include "sim/learning/training_loop/training_loop.hpp"

#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "interfaces/recording/csv.hpp"
#include "sim/learning/training_loop/checkpoint.hpp"

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

/// The heading and the rows of the first `rounds` rounds. Rows of later rounds are dropped.
std::string first_rows(const std::string& curve, int rounds) {
  std::istringstream lines(curve);
  std::string saved, line;
  for (int k = 0; k <= rounds + 1 && std::getline(lines, line); ++k) saved += line + "\n";
  return saved;
}

/// The folder of a training run.
class Folder {
 public:
  explicit Folder(const std::string& path) : path_(path) {}

  std::string state_file() const { return (path_ / "state.xml").string(); }
  /// The checkpoint of the run to be resumed.
  std::string state(bool resume) const {
    if (fs::exists(state_file()) != resume)
      throw std::invalid_argument(
          path_.string() + (resume ? ": holds no run to resume"
                                   : ": already holds a run; resume it or name another folder"));
    return resume ? text_of(state_file()) : "";
  }
  void begin(const Training& training, bool resumed) {
    fs::create_directories(path_);
    curve_ = resumed ? first_rows(text_of(curve_file()), training.rounds())
                     : heading(training.metrics()) + row(0, training.metrics());
    write_checkpoint(curve_file(), curve_), write_checkpoint(state_file(), training.state());
  }
  void add(const Training& training) {
    curve_ += row(training.rounds(), training.metrics());
    write_checkpoint(curve_file(), curve_), write_checkpoint(state_file(), training.state());
  }

 private:
  std::string curve_file() const { return (path_ / "curve.csv").string(); }

  fs::path path_;
  std::string curve_;
};

}  // namespace

void run(Training& training, const LoopOptions& options, const Pool& pool) {
  Folder folder(options.folder);
  const std::string saved = pool.broadcast(pool.first() ? folder.state(options.resume) : "");
  if (options.resume) training.restore(saved, folder.state_file());
  if (pool.first()) folder.begin(training, options.resume);
  while (training.rounds() < options.rounds && !training.done()) {
    training.round(pool);
    if (pool.first()) folder.add(training);
    const bool continues = !pool.first() || options.on_round(training);
    if (pool.broadcast(continues ? "on" : "") != "on") return;
  }
}

}  // namespace sim::training_loop
