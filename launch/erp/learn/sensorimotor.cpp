#include "launch/erp/learn/learn.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <ostream>

#include "interfaces/xml/xml.hpp"
#include "launch/erp/text/gnuplot.hpp"
#include "launch/erp/text/text_files.hpp"
#include "sim/learning/sensorimotor/learned_map_file.hpp"

namespace launch {
namespace {

namespace fs = std::filesystem;
using sim::simulated_training::SensorimotorTraining;

struct Spread {
  double mean = 0, deviation = 0;
};

/// Mean and standard deviation of the error |e| over all goals in one trial.
Spread spread(const SensorimotorTraining& training, std::size_t trial) {
  double sum = 0, squares = 0;
  const auto n = static_cast<double>(training.goals().size());
  for (const auto& goal : training.goals())
    sum += goal.errors[trial], squares += std::pow(goal.errors[trial], 2);
  return {sum / n, std::sqrt(std::max(0.0, squares / n - std::pow(sum / n, 2)))};
}

sim::cameras::ViewConfig view_of(const sim::sensorimotor::Experiment& experiment,
                                 const std::string& file) {
  return xml::read<sim::cameras::ViewConfig>(
      (fs::path(file).parent_path() / experiment.view).string());
}

std::size_t trials(const SensorimotorTraining& training) {
  return training.goals().empty() ? 0 : training.goals().front().errors.size();
}

std::string sense_name(Eigen::Index sense) {
  return fmt::format("{}{}", sense % 2 ? 'y' : 'x', sense / 2 ? std::to_string(sense / 2 + 1) : "");
}

void print_synergies(const SensorimotorTraining& training, const erp::Robot& robot,
                     std::ostream& out) {
  const Eigen::MatrixXd q = training.learned().q();
  out << fmt::format("{:<24}", "Q");
  for (Eigen::Index s = 0; s < q.rows(); ++s) out << fmt::format(" {:>8}", sense_name(s));
  for (Eigen::Index m = 0; m < q.cols(); ++m) {
    out << fmt::format("\n{:<24}", robot.actuators[std::size_t(m)].name);
    for (Eigen::Index s = 0; s < q.rows(); ++s) out << fmt::format(" {:>+8.3f}", q(s, m));
  }
  out << '\n';
}

void print_errors(const SensorimotorTraining& training, std::ostream& out) {
  if (trials(training) == 0) return;
  const Spread first_trial = spread(training, 0),
               last_trial = spread(training, trials(training) - 1);
  out << fmt::format(
      "error over {} goals, tangent of the viewing angle: trial 1 {:.4f} ± {:.4f}, trial {} {:.4f} "
      "± "
      "{:.4f}, {:.1f} % of the first\n",
      training.goals().size(), first_trial.mean, first_trial.deviation, trials(training),
      last_trial.mean, last_trial.deviation, 100 * last_trial.mean / first_trial.mean);
}

/// Two panels: the matrix Q as squares (area: magnitude; filled: positive), and the error by trial.
PlotScript figure(const SensorimotorTraining& training, const erp::Robot& robot) {
  const Eigen::MatrixXd q = training.learned().q();
  std::string data = "$q << E\n", muscles, senses;
  for (Eigen::Index m = 0; m < q.cols(); ++m) {
    muscles += fmt::format("{}'{}' {}", m ? "," : "", robot.actuators[std::size_t(m)].name, m);
    for (Eigen::Index s = 0; s < q.rows(); ++s)
      data +=
          fmt::format("{} {} {} {}\n", m, s, 6 * std::sqrt(std::abs(q(s, m))), q(s, m) > 0 ? 1 : 0);
  }
  for (Eigen::Index s = 0; s < q.rows(); ++s)
    senses += fmt::format("{}'{}' {}", s ? "," : "", sense_name(s), s);
  data += "E\n$e << E\n";
  for (std::size_t k = 0; k < trials(training); ++k)
    data +=
        fmt::format("{} {} {}\n", k + 1, spread(training, k).mean, spread(training, k).deviation);
  PlotScript plot{.panels = 2};
  plot.commands =
      data +
      fmt::format(
          "E\nset multiplot layout 2,1\nset lmargin 12\nset rmargin 26\nset key outside right\n"
          "set xrange [-0.7:{}]\nset yrange [{}:-0.7]\nset xtics ({}) rotate by -20\n"
          "set ytics ({})\n",
          double(q.cols()) - 0.3, double(q.rows()) - 0.3, muscles, senses) +
      "plot $q using 1:($4 > 0 ? $2 : 1/0):3 with points pt 5 ps variable lc rgb '#0072B2' title "
      "'recruited for +', $q using 1:($4 > 0 ? 1/0 : $2):3 with points pt 4 lw 2 ps variable lc "
      "rgb "
      "'#D55E00' title 'recruited for -'\n"
      "set xtics autofreq norotate\nset ytics autofreq\nset xrange [0:*]\nset yrange [0:*]\n"
      "set grid\nset xlabel 'trial'\nset ylabel 'error, in units of the senses'\n"
      "plot $e using 1:2:3 with yerrorbars lw 1.5 lc rgb '#888888' title 'spread over goals', $e "
      "using 1:2 with linespoints lw 2 pt 7 lc rgb '#0072B2' title 'mean'\nunset multiplot\n";
  return plot;
}

}  // namespace

int learn_goals(const std::string& robot_file, const std::string& experiment_file,
                const sim::simulated_training::GoalDraw& draw, int threads, std::ostream& out) {
  const erp::Robot robot = erp::read_robot(robot_file);
  auto experiment = xml::read<sim::sensorimotor::Experiment>(experiment_file);
  const sim::sensorimotor::Eye eye(view_of(experiment, experiment_file), sim::RobotTree(robot));
  experiment.grids.clear();
  experiment.goals = reachable_goals(robot, eye, draw, sim::Threads(threads));
  out << xml::write(experiment);
  return 0;
}

int learn_sensorimotor(const SensorimotorOptions& options, std::ostream& out,
                       std::ostream& remarks) {
  const auto pool = sim::make_pool(options.training.threads);
  const erp::Robot robot = erp::read_robot(options.robot);
  auto experiment = xml::read<sim::sensorimotor::Experiment>(options.experiment);
  if (options.seed != 0) experiment.seed = options.seed;
  SensorimotorTraining training(robot, view_of(experiment, options.experiment), experiment);
  TrainingRunOptions run = options.training;
  run.rounds = 1 + experiment.session.trials;
  const bool is_complete = run_training(training, run, *pool, remarks);
  if (!pool->first()) return 0;
  write_file(run.folder + "/learned.xml", training.state());
  draw(figure(training, robot), run.folder + "/figure.svg");
  print_synergies(training, robot, out);
  print_errors(training, out);
  if (training.limited() > 0)
    out << fmt::format("{} trials exceeded {:.0f} N above rest at a muscle and were scaled down\n",
                       training.limited(), experiment.session.most_N);
  out << fmt::format(
      "{0}/learned.xml is an initial map for the component sensorimotor, "
      "{0}/figure.svg shows it\n",
      run.folder);
  return is_complete ? 0 : 1;
}

}  // namespace launch
