#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <ostream>

#include "interfaces/parallel/pool.hpp"
#include "launch/erp/gap/gap.hpp"
#include "launch/erp/text/text_files.hpp"
#include "sim/gap/estimation/as_built.hpp"

namespace launch::gap {
namespace {

namespace estimation = sim::estimation;

constexpr double quantile_97_5 = 1.96;   // of the normal distribution, for 95 % intervals
constexpr double max_mean_square = 1.5;  // of a stage's residual in units of its noise; chosen

void print_row(const estimation::AsBuilt& built, std::size_t k, std::ostream& out) {
  const estimation::Constant& c = built.uncertain.constants[k];
  const double x = built.estimate.point.x[k],
               half_interval = quantile_97_5 * built.estimate.sigma(k);
  constexpr double limit = 3;  // in tolerances and in standard errors; chosen
  const bool is_beyond = std::ranges::count(built.beyond_tolerance, k) > 0 ||
                         (std::abs(x) > limit && std::abs(x) > limit * built.estimate.sigma(k));
  const char* remark = is_beyond ? "beyond its tolerance"
                       : estimation::determined(built, k) < estimation::determined_threshold
                           ? "not determined"
                           : "";
  out << fmt::format("{:<16} {:<28} {:>11.5g} {:>11.5g} {:>11.5g} … {:<11.5g} {}\n", c.on, c.name,
                     c.nominal, c.value(x), c.value(x - half_interval), c.value(x + half_interval),
                     remark);
}

/// Prints the stages with a residual above the noise after the estimation of all constants.
void print_unexplained(const std::vector<std::string>& names, const estimation::AsBuilt& built,
                       std::ostream& out) {
  for (std::size_t s = 0; s < names.size(); ++s)
    if (built.estimate.mean_square[s] > max_mean_square)
      out << fmt::format(
          "unexplained {}: residual {:.3g} times its noise; no constant explains it; run erp gap "
          "diagnose\n",
          names[s], std::sqrt(built.estimate.mean_square[s]));
}

}  // namespace

int calibrate(const CalibrateOptions& options, std::ostream& out, std::ostream& remarks) {
  const erp::Robot robot = read_chains(options.robot);
  if (!robot.drives.empty())
    throw std::invalid_argument(
        options.robot + ": has drives; erp gap diagnose estimates their constants as effects");
  if (!options.out.empty() && std::filesystem::exists(options.out) &&
      std::filesystem::equivalent(options.out, options.robot))
    throw std::invalid_argument("--out " + options.out +
                                ": is the model given by --robot; choose another file");
  if (!options.out.empty())
    check_folder(std::filesystem::absolute(options.out).parent_path().string());
  const Reading read = read_episodes(robot, options.recordings);
  const auto pool = sim::make_pool(options.threads);
  if (pool->first()) print_lines(read.corrections, remarks), print_suspicious(read, remarks);
  if (!can_evaluate(read.episodes)) {
    if (pool->first()) out << nothing_evaluated;
    return 5;
  }
  estimation::EstimateOptions estimate_options;
  estimate_options.threads = options.threads, estimate_options.seed = options.seed,
  estimate_options.pool = pool.get();
  const estimation::AsBuilt built = estimation::calibrated(robot, read.episodes, estimate_options);
  if (!pool->first()) return 0;
  out << fmt::format("{:<16} {:<28} {:>11} {:>11} {:>25}\n", "on", "constant", "robot.xml",
                     "estimate", "95 % interval");
  for (std::size_t k = 0; k < built.uncertain.constants.size(); ++k) print_row(built, k, out);
  std::vector<std::string> stages;
  for (const auto& r : sim::residuals::Stages(robot).explain(read.episodes[0]).residuals)
    stages.push_back(fmt::format("{} of {}", sim::effects::word(r.stage), r.on));
  print_unexplained(stages, built, out);
  if (options.out.empty()) return 0;
  make_folder(std::filesystem::absolute(options.out).parent_path().string());
  write_file(options.out, erp::write_robot(built.robot));
  out << "written     " << options.out << "\n";
  return 0;
}

}  // namespace launch::gap
