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

/// The recordings of all three lists, each once, and which of them are to train and to judge.
struct Sorted {
  std::vector<std::string> files;
  std::vector<std::size_t> train, held_out;
};

/// However they are written.
bool same_file(const std::string& a, const std::string& b) {
  namespace fs = std::filesystem;
  return a == b || fs::weakly_canonical(a) == fs::weakly_canonical(b);
}

Sorted sort(const DiagnoseOptions& options) {
  Sorted sorted;
  const auto index = [&](const std::string& file) {
    const auto found = std::ranges::find_if(
        sorted.files, [&](const std::string& other) { return same_file(other, file); });
    if (found != sorted.files.end()) return static_cast<std::size_t>(found - sorted.files.begin());
    sorted.files.push_back(file);
    return sorted.files.size() - 1;
  };
  for (const std::string& file : options.recordings) {
    if (std::ranges::any_of(sorted.files,
                            [&](const std::string& other) { return same_file(other, file); }))
      throw std::invalid_argument(file + ": named twice; name each recording once");
    index(file);
  }
  for (const std::string& file : options.train) sorted.train.push_back(index(file));
  for (const std::string& file : options.held_out) sorted.held_out.push_back(index(file));
  const auto rest = [&](std::vector<std::size_t>& into, const std::vector<std::size_t>& others) {
    for (std::size_t k = 0; k < sorted.files.size(); ++k)
      if (!std::ranges::count(others, k)) into.push_back(k);
  };
  if (sorted.train.empty() && !sorted.held_out.empty()) rest(sorted.train, sorted.held_out);
  else if (sorted.held_out.empty() && !sorted.train.empty()) rest(sorted.held_out, sorted.train);
  if (!options.held_out.empty() && sorted.train.empty())
    throw std::invalid_argument("--held-out names every recording; leave some to train on");
  for (const std::size_t k : sorted.train)
    if (std::ranges::count(sorted.held_out, k))
      throw std::invalid_argument(sorted.files[k] +
                                  ": both in --train and --held-out; name it in one of them");
  return sorted;
}

void write_found(const diagnosis::Diagnosis& d, const sim::closed_loop::FreeRun& free_run,
                 const erp::Robot& robot, const erp::Robot& found, const DiagnoseOptions& options) {
  make_folder(options.out);
  write_file(options.out + "/diagnosis.json", diagnosis_json(d, free_run, robot));
  write_file(options.out + "/report.html", diagnosis_report(d, free_run, robot));
  const std::string mended = options.out + "/robot.xml";
  if (d.verdict == diagnosis::Verdict::supported && d.as_built)
    write_file(mended, erp::write_robot(found));
  else if (d.verdict == diagnosis::Verdict::supported)
    write_mended(mended, options.robot, found,
                 {found.effects.end() - std::ptrdiff_t(d.answer.size()), found.effects.end()});
  else std::filesystem::remove(mended);  // of an earlier diagnosis
}

/// What is written there must not cost anybody a model.
void check_out(const DiagnoseOptions& options) {
  namespace fs = std::filesystem;
  const std::string mended = options.out + "/robot.xml";
  if (options.out.empty() || !fs::exists(mended)) return;
  if (fs::equivalent(mended, options.robot))
    throw std::invalid_argument("--out " + options.out +
                                ": its robot.xml is the model itself; name another folder");
  if (!fs::exists(options.out + "/diagnosis.json"))
    throw std::invalid_argument("--out " + options.out +
                                ": holds a robot.xml that no diagnosis wrote; name another folder");
}

}  // namespace

void check_withheld(const std::vector<std::string>& types) {
  std::vector<std::string> known;
  for (const auto& effect : sim::effects::library())
    known.emplace_back(sim::effects::about(effect).type);
  for (const std::string& type : types)
    if (!sim::effects::neutral(type))
      throw std::invalid_argument("--withhold " + type + ": no such effect: " +
                                  xml::did_you_mean(type, known) + " erp model effects lists them");
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

/// Under mpirun each process diagnoses, and shares out derivatives and the screening of effects; the first reports.
int diagnose(const DiagnoseOptions& options, std::ostream& out, std::ostream& remarks) {
  const auto pool = sim::make_pool(options.threads);
  const erp::Robot robot = read_chains(options.robot);
  check_withheld(options.withhold);
  check_out(options);
  const Sorted sorted = sort(options);
  const Reading read = read_episodes(robot, sorted.files);
  if (pool->first()) tell(read.mended, remarks), print_suspicious(read, remarks);
  if (!options.out.empty()) check_folder(options.out);
  std::optional<Progress> progress(std::in_place, remarks);
  diagnosis::DiagnoseOptions how{.train = sorted.train,
                                 .held_out = sorted.held_out,
                                 .withhold = options.withhold,
                                 .threads = options.threads,
                                 .pool = pool.get(),
                                 .seed = options.seed};
  how.progress = [&](const std::string& what, double share) {
    if (pool->first()) progress->tell(what, share);
  };
  diagnosis::Diagnosis d = diagnosis::diagnose(robot, read.episodes, how);
  if (!pool->first()) return 0;
  const auto free_run = run_freely(d, read.episodes, robot, options,
                                   [&](double share) { progress->tell("free run", share); });
  erp::Robot found = d.as_built ? *d.as_built : erp::read_robot(options.robot);
  for (const auto& n : d.as_built ? std::vector<diagnosis::IdentifiedEffect>{} : d.answer)
    found.effects.push_back(sim::effects::written(n.placed));
  progress.reset();
  d.warnings.insert(d.warnings.end(), free_run.remarks.begin(), free_run.remarks.end());
  d.fix_first = read.odd;
  if (!d.fix_first.empty() && d.verdict == diagnosis::Verdict::no_gap)
    d.verdict = diagnosis::Verdict::not_identifiable;  // what looks wrong was not judged
  else if (!free_run.channels.empty() || d.verdict == diagnosis::Verdict::supported)
    for (const std::string& doubt : doubts(d, free_run.all, robot)) d.warnings.push_back(doubt);
  if (!options.withhold.empty())
    out << fmt::format("withheld    {}\n", fmt::join(options.withhold, ", "));
  print_answer(d, free_run, out);
  d.warnings.insert(d.warnings.begin(), read.odd.begin(), read.odd.end());
  d.warnings.insert(d.warnings.begin(), read.mended.begin(), read.mended.end());
  if (!options.out.empty()) {
    write_found(d, free_run, robot, found, options);
    out << fmt::format(
        "report      {0}/report.html, {0}/diagnosis.json{1}\n", options.out,
        d.verdict == diagnosis::Verdict::supported ? ", " + options.out + "/robot.xml" : "");
    print_next(d, robot, options, out);
  }
  return exit_code(d.verdict);
}

}  // namespace launch::gap
