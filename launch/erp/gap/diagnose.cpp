#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <ostream>

#include "interfaces/xml/words.hpp"
#include "launch/erp/gap/answer_lines.hpp"
#include "launch/erp/gap/files.hpp"
#include "launch/erp/gap/free_run_lines.hpp"
#include "launch/erp/gap/gap.hpp"
#include "launch/erp/gap/messages.hpp"
#include "launch/erp/text/progress.hpp"
#include "launch/erp/text/text_files.hpp"

namespace launch::gap {
namespace {

namespace diagnosis = sim::diagnosis;
namespace residuals = sim::residuals;

/// All recordings, each once, and the indices of those for training and for validation.
struct RecordingSplit {
  std::vector<std::string> files;
  std::vector<std::size_t> train, held_out;
};

/// Whether two paths refer to the same file.
bool same_file(const std::string& a, const std::string& b) {
  namespace fs = std::filesystem;
  return a == b || fs::weakly_canonical(a) == fs::weakly_canonical(b);
}

/// Combines the options --real, --train and --held-out. If only one of --train and --held-out is
/// given, the other one consists of the remaining recordings. Throws std::invalid_argument for
/// contradictions.
RecordingSplit split(const DiagnoseOptions& options) {
  RecordingSplit recordings;
  const auto index = [&](const std::string& file) {
    const auto found = std::ranges::find_if(
        recordings.files, [&](const std::string& other) { return same_file(other, file); });
    if (found != recordings.files.end())
      return static_cast<std::size_t>(found - recordings.files.begin());
    recordings.files.push_back(file);
    return recordings.files.size() - 1;
  };
  for (const std::string& file : options.recordings) {
    if (std::ranges::any_of(recordings.files,
                            [&](const std::string& other) { return same_file(other, file); }))
      throw std::invalid_argument(file + ": given twice; give each recording once");
    index(file);
  }
  for (const std::string& file : options.train) recordings.train.push_back(index(file));
  for (const std::string& file : options.held_out) recordings.held_out.push_back(index(file));
  const auto add_others = [&](std::vector<std::size_t>& target,
                              const std::vector<std::size_t>& others) {
    for (std::size_t k = 0; k < recordings.files.size(); ++k)
      if (!std::ranges::count(others, k)) target.push_back(k);
  };
  if (recordings.train.empty() && !recordings.held_out.empty())
    add_others(recordings.train, recordings.held_out);
  else if (recordings.held_out.empty() && !recordings.train.empty())
    add_others(recordings.held_out, recordings.train);
  if (!options.held_out.empty() && recordings.train.empty())
    throw std::invalid_argument(
        "--held-out contains every recording; leave at least one for training");
  for (const std::size_t k : recordings.train)
    if (std::ranges::count(recordings.held_out, k))
      throw std::invalid_argument(recordings.files[k] +
                                  ": in both --train and --held-out; remove it from one of them");
  return recordings;
}

void write_files(const diagnosis::Diagnosis& d, const sim::closed_loop::FreeRun& free_run,
                 const erp::Robot& robot, const erp::Robot& found, const DiagnoseOptions& options) {
  make_folder(options.out);
  write_file(options.out + "/diagnosis.json", diagnosis_json(d, free_run, robot));
  write_file(options.out + "/report.html", diagnosis_report(d, free_run, robot));
  const std::string corrected_file = options.out + "/robot.xml";
  if (d.verdict == diagnosis::Verdict::supported && d.as_built)
    write_file(corrected_file, erp::write_robot(found));
  else if (d.verdict == diagnosis::Verdict::supported)
    write_corrected(corrected_file, options.robot, found,
                    {found.effects.end() - std::ptrdiff_t(d.answer.size()), found.effects.end()});
  else std::filesystem::remove(corrected_file);  // may exist from an earlier diagnosis
}

/// Throws std::invalid_argument if writing robot.xml would overwrite a model.
void check_out(const DiagnoseOptions& options) {
  namespace fs = std::filesystem;
  const std::string corrected_file = options.out + "/robot.xml";
  if (options.out.empty() || !fs::exists(corrected_file)) return;
  if (fs::equivalent(corrected_file, options.robot))
    throw std::invalid_argument(
        "--out " + options.out +
        ": its robot.xml is the model given by --robot; choose another folder");
  if (!fs::exists(options.out + "/diagnosis.json"))
    throw std::invalid_argument(
        "--out " + options.out +
        ": contains a robot.xml that erp gap diagnose did not write; choose another folder");
}

}  // namespace

void check_withheld(const std::vector<std::string>& types) {
  std::vector<std::string> valid_types;
  for (const auto& effect : sim::effects::library())
    valid_types.emplace_back(sim::effects::about(effect).type);
  for (const std::string& type : types)
    if (!sim::effects::neutral(type))
      throw std::invalid_argument("--withhold " + type +
                                  ": unknown effect: " + xml::did_you_mean(type, valid_types) +
                                  " erp model effects lists all effects");
}

int exit_code(diagnosis::Verdict verdict) {
  switch (verdict) {
    case diagnosis::Verdict::supported:
      return 0;
    case diagnosis::Verdict::no_gap:
      return 3;
    case diagnosis::Verdict::none_of_the_known:
      return 4;
    case diagnosis::Verdict::not_identifiable:
      break;
  }
  return 5;
}

/// Under mpirun the processes share the screening of effects and the derivatives; the first process
/// reports.
int diagnose(const DiagnoseOptions& options, std::ostream& out, std::ostream& remarks) {
  const auto pool = sim::make_pool(options.threads);
  const erp::Robot robot = read_chains(options.robot);
  check_withheld(options.withhold);
  check_out(options);
  const RecordingSplit recordings = split(options);
  const Reading read = read_episodes(robot, recordings.files);
  if (pool->first()) print_lines(read.corrections, remarks), print_suspicious(read, remarks);
  if (!options.out.empty()) check_folder(options.out);
  std::optional<Progress> progress(std::in_place, remarks);
  diagnosis::DiagnoseOptions diagnose_options{.train = recordings.train,
                                              .held_out = recordings.held_out,
                                              .withhold = options.withhold,
                                              .threads = options.threads,
                                              .pool = pool.get(),
                                              .seed = options.seed};
  diagnose_options.progress = [&](const std::string& step, double fraction) {
    if (pool->first()) progress->show(step, fraction);
  };
  diagnosis::Diagnosis d = diagnosis::diagnose(robot, read.episodes, diagnose_options);
  if (!pool->first()) return 0;
  const auto free_run = free_run_of(d, read.episodes, robot, options,
                                    [&](double fraction) { progress->show("free run", fraction); });
  erp::Robot found = d.as_built ? *d.as_built : erp::read_robot(options.robot);
  for (const auto& n : d.as_built ? std::vector<diagnosis::IdentifiedEffect>{} : d.answer)
    found.effects.push_back(sim::effects::written(n.placed));
  progress.reset();
  d.warnings.insert(d.warnings.end(), free_run.remarks.begin(), free_run.remarks.end());
  d.fix_first = read.suspicious;
  if (!d.fix_first.empty() && d.verdict == diagnosis::Verdict::no_gap)
    d.verdict = diagnosis::Verdict::not_identifiable;  // suspicious columns were not evaluated
  else if (!free_run.channels.empty() || d.verdict == diagnosis::Verdict::supported)
    for (const std::string& warning : answer_warnings(d, free_run.all, robot))
      d.warnings.push_back(warning);
  if (!options.withhold.empty())
    out << fmt::format("withheld    {}\n", fmt::join(options.withhold, ", "));
  print_answer(d, free_run, out);
  d.warnings.insert(d.warnings.begin(), read.suspicious.begin(), read.suspicious.end());
  d.warnings.insert(d.warnings.begin(), read.corrections.begin(), read.corrections.end());
  if (!options.out.empty()) {
    write_files(d, free_run, robot, found, options);
    out << fmt::format(
        "report      {0}/report.html, {0}/diagnosis.json{1}\n", options.out,
        d.verdict == diagnosis::Verdict::supported ? ", " + options.out + "/robot.xml" : "");
    print_next(d, robot, options, out);
  }
  return exit_code(d.verdict);
}

}  // namespace launch::gap
