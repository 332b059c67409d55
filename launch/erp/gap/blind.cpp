#include "launch/erp/gap/blind.hpp"

#include <fmt/format.h>

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <mutex>
#include <nlohmann/json.hpp>
#include <sstream>

#include "interfaces/parallel/in_parallel.hpp"
#include "interfaces/recording/csv.hpp"
#include "launch/erp/gap/files.hpp"
#include "launch/erp/gap/free_run_lines.hpp"
#include "launch/erp/gap/gap.hpp"
#include "launch/erp/gap/truth.hpp"
#include "launch/erp/text/progress.hpp"
#include "launch/erp/text/text_files.hpp"
#include "sim/gap/blind/visibility.hpp"
#include "sim/gap/diagnosis/diagnose.hpp"

namespace launch::gap {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

/// Removes the columns of the signals in `without`, and rounds to nine decimals, which is finer
/// than every quantization step.
recording::Table as_recorded(recording::Table table, const std::vector<std::string>& without) {
  const auto is_removed = [&](const recording::Column& column) {
    const auto signal = recording::signal_of(column.name);
    for (const std::string& kind : without) {
      if (kind == "tension" && signal == "tension_N") return true;
      if (kind == "current" && signal == "current_A") return true;
      if (kind == "joint" && (signal == "angle_rad" || signal[0] == 'q')) return true;
    }
    return false;
  };
  std::erase_if(table.columns, is_removed);
  constexpr double decimals = 1e9;
  for (recording::Column& column : table.columns)
    for (double& value : column.values) value = std::round(value * decimals) / decimals;
  return table;
}

Json truth_of(const std::string& name, const sim::blind::Case& blind) {
  Json hidden = Json::array();
  for (const sim::blind::Hidden& h : blind.hidden) {
    Json parameters = Json::object();
    for (const auto& [parameter, value] : h.parameters) parameters[parameter] = value;
    hidden.push_back(
        {{"type", h.type}, {"stage", h.stage}, {"on", h.on}, {"parameters", parameters}});
  }
  Json numbers = Json::array();
  for (const sim::blind::Drawn& d : blind.built.drawn)
    numbers.push_back({{"on", d.on}, {"name", d.name}, {"value", d.value}});
  return {{"case", name},
          {"kind", sim::blind::word(blind.kind)},
          {"seed", blind.seed},
          {"hidden", hidden},
          {"numbers", numbers}};
}

/// A recorded case: one CSV per recording.
struct Recorded {
  sim::blind::Case blind;
  std::vector<std::string> csv;
  int not_finite = 0;  ///< draws that were discarded because their motion was not finite
};

/// Draws a case and records it. Repeats the draw if the motion is not finite.
Recorded record_case(const erp::Robot& robot, sim::blind::Kind kind, std::uint64_t seed,
                     const BlindMakeOptions& options, const sim::blind::Visibility& visibility) {
  constexpr std::uint64_t seed_step = 1'000'003;  // greater than the number of cases; chosen
  constexpr int max_draws = 20;                   // chosen
  for (int draw = 0;; ++draw) {
    Recorded recorded{sim::blind::draw_case(robot, kind, seed + seed_step * std::uint64_t(draw),
                                            options.only, visibility),
                      {},
                      draw};
    if (options.tolerance > 0)
      recorded.blind.built = sim::blind::as_built(robot, options.tolerance, recorded.blind.seed,
                                                  recorded.blind.hidden_effects);
    try {
      for (int r = 0; r < options.recordings; ++r) {
        const auto excitation = sim::excitation(robot, r, options.seconds, seed);
        const auto table = sim::blind::record(robot, recorded.blind, excitation,
                                              seed * 1000 + static_cast<std::uint64_t>(r));
        std::ostringstream text;
        recording::write_csv(as_recorded(table, options.without), text);
        recorded.csv.push_back(text.str());
      }
      return recorded;
    } catch (const sim::blind::NotFinite&) {
      if (draw == max_draws) throw;
    }
  }
}

/// Index of this process and number of processes under Open MPI; otherwise 0 and 1.
std::pair<std::size_t, std::size_t> part_of_work() {
  const auto number = [](const char* name, std::size_t default_value) {
    const char* text = std::getenv(name);
    return text ? static_cast<std::size_t>(std::strtoul(text, nullptr, 10)) : default_value;
  };
  return {number("OMPI_COMM_WORLD_RANK", 0),
          std::max<std::size_t>(1, number("OMPI_COMM_WORLD_SIZE", 1))};
}

/// Throws std::invalid_argument if no case can be made from the robot, or if files would be
/// overwritten.
void check(const BlindMakeOptions& options, const erp::Robot& robot) {
  if (robot.actuators.empty())
    throw std::invalid_argument(
        options.robot + ": has no actuator, so no effect can be hidden; pass a robot with muscles");
  if (!robot.effects.empty())
    throw std::invalid_argument(options.robot +
                                ": has effects, which the cases do not include; remove them");
  if (options.kind == "many" && options.tolerance > 0)
    throw std::invalid_argument(
        fmt::format("--tolerance {}: --kind many draws its own deviations; remove --tolerance",
                    options.tolerance));
  if (fs::exists(options.out + "/cases.json"))
    throw std::invalid_argument(options.out +
                                ": already contains cases; move it or choose another folder");
  if (fs::exists(options.truth))
    throw std::invalid_argument("--truth " + options.truth +
                                ": exists and belongs to other cases; choose another file");
  const fs::path truth_in_out =
      fs::weakly_canonical(options.truth).lexically_relative(fs::weakly_canonical(options.out));
  if (!truth_in_out.empty() && *truth_in_out.begin() != "..")
    throw std::invalid_argument(
        "--truth " + options.truth +
        ": is in the folder of the cases, which must not contain the truth; choose another file");
}

}  // namespace

int blind_make(const BlindMakeOptions& options, std::ostream& out, std::ostream& remarks) {
  const erp::Robot robot = erp::read_robot(options.robot);
  const auto kind = sim::blind::kind_of(options.kind);
  check(options, robot);
  if (const fs::path folder = fs::path(options.truth).parent_path(); !folder.empty())
    make_folder(folder);
  make_folder(options.out);
  write_file(options.out + "/robot.xml", erp::write_robot(robot));
  const auto count = static_cast<std::size_t>(options.cases);
  std::vector<Json> truths(count), cases(count);
  const sim::blind::Visibility visibility(robot);
  std::atomic<int> rejected_draws = 0, not_finite = 0;
  std::size_t done = 0;
  std::mutex progress_mutex;
  Progress progress(remarks);
  sim::in_parallel(count, options.threads, [&](std::size_t k) {
    const std::string name = fmt::format("case_{:04}", k + 1);
    const Recorded recorded = record_case(robot, kind, options.seed + k, options, visibility);
    rejected_draws += recorded.blind.rejected_draws, not_finite += recorded.not_finite;
    fs::create_directories(options.out + "/" + name);
    Json files = Json::array();
    for (std::size_t r = 0; r < recorded.csv.size(); ++r) {
      files.push_back(fmt::format("{}/{}.csv", name, r + 1));
      write_file(options.out + "/" + files.back().get<std::string>(), recorded.csv[r]);
    }
    cases[k] = {{"case", name}, {"recordings", files}, {"withhold", recorded.blind.withhold}};
    truths[k] = truth_of(name, recorded.blind);
    const std::lock_guard lock(progress_mutex);
    progress.show("cases", double(++done) / double(count));
  });
  const std::string truth = Json(truths).dump(1) + "\n";
  write_file(options.truth, truth);
  const Json manifest{{"format", "erp gap blind 1"},
                      {"robot", "robot.xml"},
                      {"truth_sha256", sha256(truth)},
                      {"cases", cases}};
  write_file(options.out + "/cases.json", manifest.dump(1) + "\n");
  out << fmt::format("{} {} in {}\ntruth       {}\nsha256      {}\n", count,
                     count == 1 ? "case" : "cases", options.out, options.truth, sha256(truth));
  if (rejected_draws > 0)
    out << fmt::format("redrawn     {} whose hidden effect changed no reading\n",
                       rejected_draws.load());
  if (not_finite > 0)
    out << fmt::format("redrawn     {} whose motion was not finite\n", not_finite.load());
  return 0;
}

int blind_run(const BlindRunOptions& options, std::ostream& out, std::ostream& remarks) {
  const std::string& folder = options.folder;
  const Json manifest = Json::parse(read_text(folder + "/cases.json"));
  const erp::Robot robot = erp::read_robot(folder + "/robot.xml");
  const auto [part, parts] = part_of_work();
  std::vector<Json> own_cases;
  std::size_t n = 0;
  for (const Json& entry : manifest["cases"])
    if (n++ % parts == part &&
        !fs::exists(folder + "/" + entry["case"].get<std::string>() + "/diagnosis.json"))
      own_cases.push_back(entry);
  std::atomic<std::size_t> done = 0;
  std::mutex progress_mutex;
  Progress progress(remarks);
  sim::in_parallel(own_cases.size(), options.threads, [&](std::size_t k) {
    std::vector<std::string> files;
    for (const Json& file : own_cases[k]["recordings"])
      files.push_back(folder + "/" + file.get<std::string>());
    sim::diagnosis::DiagnoseOptions diagnose_options{.threads = 1};
    diagnose_options.withhold = own_cases[k]["withhold"].get<std::vector<std::string>>();
    const auto episodes = read_episodes(robot, files).episodes;
    auto d = sim::diagnosis::diagnose(robot, episodes, diagnose_options);
    const DiagnoseOptions free_run_options{.threads = 1, .free_run = options.free_run};
    const auto free_run = free_run_of(d, episodes, robot, free_run_options, [](double) {});
    const std::string case_folder = folder + "/" + own_cases[k]["case"].get<std::string>();
    write_file(case_folder + "/diagnosis.part", diagnosis_json(d, free_run, robot));
    fs::rename(case_folder + "/diagnosis.part", case_folder + "/diagnosis.json");
    const std::lock_guard lock(progress_mutex);
    progress.show("diagnoses", double(++done) / double(own_cases.size()));
  });
  out << fmt::format("{} {} in {}\n", own_cases.size(),
                     own_cases.size() == 1 ? "diagnosis" : "diagnoses", folder);
  return 0;
}

}  // namespace launch::gap
