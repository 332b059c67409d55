#include "launch/erp/learn/learn.hpp"

#include <fmt/format.h>

#include <array>
#include <ostream>

#include "interfaces/xml/document.hpp"
#include "interfaces/xml/xml.hpp"
#include "launch/erp/learn/task_poses.hpp"
#include "launch/erp/text/gnuplot.hpp"
#include "launch/erp/text/text_files.hpp"
#include "sim/learning/simulated_training/experience_training.hpp"
#include "sim/learning/training_loop/random_stream.hpp"

namespace launch {
namespace {

using sim::Vec3;
using sim::experience::FeedbackKind;
using sim::experience::Task;
using sim::simulated_training::ExperienceTraining;

constexpr std::array feedback_kinds{FeedbackKind::none, FeedbackKind::linear, FeedbackKind::fuzzy};
constexpr std::array feedback_names{"feed-forward", "linear", "fuzzy"};

std::shared_ptr<const sim::experience::Feedback> feedback(FeedbackKind kind, const Task& task,
                                                          const ExperienceTraining& training,
                                                          int start, const Vec3& target_m) {
  using namespace sim::experience;
  if (kind == FeedbackKind::linear)
    return linear_feedback(training.base(), start, target_m, task.feedback_gain_per_s);
  if (kind == FeedbackKind::fuzzy)
    return fuzzy_feedback(training.base(), start, xml::resolved(task.rules, task.place.file));
  return nullptr;
}

/// Tests with new targets: the hand reaches for each target with each kind of feedback. The
/// starting poses alternate.
class Tests {
 public:
  Tests(const ExperienceTraining& training, const erp::Robot& robot, const Task& task)
      : training_(training), robot_(robot), task_(task) {
    if (task.rules.empty()) kinds_.pop_back();
  }

  /// Runs all tests. Returns false if interrupted.
  bool run(const ExperienceOptions& options, const sim::Pool& pool, std::ostream& remarks) {
    const auto test_count = static_cast<std::size_t>(options.tests) * kinds_.size();
    offsets_m_ = run_tests(
        test_count,
        [&](std::size_t k) {
          const Vec3 offset_m =
              final_offset_m(k / kinds_.size(), kinds_[k % kinds_.size()], nullptr);
          return sim::Pool::Numbers(offset_m.begin(), offset_m.end());
        },
        options.training, pool, remarks);
    return offsets_m_.size() == test_count;
  }
  std::size_t count() const { return offsets_m_.size() / kinds_.size(); }
  std::size_t kinds() const { return kinds_.size(); }
  Vec3 target_m(std::size_t test) const {
    return training_.fresh_target(static_cast<std::uint64_t>(task_.seed), test);
  }
  Vec3 offset_m(std::size_t test, std::size_t kind) const {
    return Eigen::Map<const Vec3>(offsets_m_[test * kinds_.size() + kind].data());
  }
  sim::simulated_training::HandTrack track(std::size_t test, std::size_t kind) const {
    sim::simulated_training::HandTrack track;
    final_offset_m(test, kinds_[kind], &track);
    return track;
  }

 private:
  /// Final offset of the hand from the target, in m, without measurement noise. NaN if an ECU
  /// tripped.
  Vec3 final_offset_m(std::size_t test, FeedbackKind kind,
                      sim::simulated_training::HandTrack* result) const {
    const int start = static_cast<int>(test % training_.file().starts.all.size());
    const Vec3 target = target_m(test);
    auto reach = training_.reach(start, target, feedback(kind, task_, training_, start, target));
    sim::simulated_training::HandTrack unused_track, &track = result ? *result : unused_track;
    constexpr std::uint64_t noise_stream = 77;  // differs from the stream of the targets; chosen
    const auto seed = sim::training_loop::random_stream(static_cast<std::uint64_t>(task_.seed),
                                                        test, noise_stream)();
    if (!play(reach, robot_, task_.hand, task_.noise_m, seed, &track))
      return Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
    return track.hand_m.back() - target;
  }

  const ExperienceTraining& training_;
  const erp::Robot& robot_;
  const Task& task_;
  std::vector<FeedbackKind> kinds_{feedback_kinds.begin(), feedback_kinds.end()};
  std::vector<sim::Pool::Numbers> offsets_m_;
};

void print_offsets(const Tests& tests, std::ostream& out) {
  out << fmt::format("offset at rest, {} new targets, mm\n{:<14}{:>22}{:>22}{:>22}\n",
                     tests.count(), "", "x  mean / max", "y  mean / max", "z  mean / max");
  for (std::size_t kind = 0; kind < tests.kinds(); ++kind) {
    Vec3 sum_mm = Vec3::Zero(), max_offset_mm = Vec3::Zero();
    std::size_t tripped = 0;
    for (std::size_t k = 0; k < tests.count(); ++k) {
      const Vec3 offset_mm = 1e3 * tests.offset_m(k, kind).cwiseAbs();
      if (!offset_mm.allFinite()) {
        ++tripped;
        continue;
      }
      sum_mm += offset_mm, max_offset_mm = max_offset_mm.cwiseMax(offset_mm);
    }
    const Vec3 mean_mm =
        sum_mm / static_cast<double>(std::max<std::size_t>(1, tests.count() - tripped));
    out << fmt::format("{:<14}", feedback_names[kind]);
    for (int axis = 0; axis < 3; ++axis)
      out << fmt::format("{:>14.2f} / {:>5.2f}", mean_mm[axis], max_offset_mm[axis]);
    out << (tripped ? fmt::format("   {} ended by an ECU that tripped\n", tripped) : "\n");
  }
}

std::string csv_of(const Tests& tests) {
  std::string text = "test,feedback,target_x_m,target_y_m,target_z_m,off_x_mm,off_y_mm,off_z_mm\n";
  for (std::size_t k = 0; k < tests.count(); ++k)
    for (std::size_t kind = 0; kind < tests.kinds(); ++kind) {
      const Vec3 target_m = tests.target_m(k), offset_mm = 1e3 * tests.offset_m(k, kind);
      text += fmt::format("{},{},{:.6f},{:.6f},{:.6f},{:.4f},{:.4f},{:.4f}\n", k + 1,
                          feedback_names[kind], target_m.x(), target_m.y(), target_m.z(),
                          offset_mm.x(), offset_mm.y(), offset_mm.z());
    }
  return text;
}

/// Path of the hand in the first test, by axis, with both kinds of feedback, and the target.
PlotScript figure(const Tests& tests) {
  constexpr std::array colours{"#0072B2", "#D55E00"};
  std::string data, plots;
  for (std::size_t kind = 1; kind < tests.kinds(); ++kind) {
    const auto track = tests.track(0, kind);
    data += fmt::format("$way{} << E\n", kind);
    constexpr std::size_t every = 10;  // samples per plotted point; chosen
    for (std::size_t k = 0; k < track.time_s.size(); k += every)
      data +=
          fmt::format("{} {} {} {} {}\n", track.time_s[k], track.hand_m[k].x(), track.hand_m[k].y(),
                      track.hand_m[k].z(), 1e3 * (track.hand_m[k] - tests.target_m(0)).norm());
    data += "E\n";
  }
  for (int axis = 0; axis < 3; ++axis) {
    plots += fmt::format("set ylabel '{} m'\n", "xyz"[axis]);
    plots += fmt::format("plot {} with lines lw 1.5 dt 2 lc rgb '#444444' title 'target'",
                         tests.target_m(0)[axis]);
    for (std::size_t kind = 1; kind < tests.kinds(); ++kind)
      plots += fmt::format(", $way{} using 1:{} with lines lw 2 lc rgb '{}' title '{} feedback'",
                           kind, axis + 2, colours[kind - 1], feedback_names[kind]);
    plots += "\n";
  }
  plots += "set ylabel 'off mm'\nset logscale y\nset xlabel 's'\nplot";
  for (std::size_t kind = 1; kind < tests.kinds(); ++kind)
    plots += fmt::format("{} $way{} using 1:5 with lines lw 2 lc rgb '{}' title '{} feedback'",
                         kind > 1 ? "," : "", kind, colours[kind - 1], feedback_names[kind]);
  plots += "\n";
  return {.commands = data +
                      "set multiplot layout 4,1\nset lmargin 12\nset rmargin 22\n"
                      "set key outside right\nset grid\n" +
                      plots + "unset multiplot\n",
          .panels = 4};
}

}  // namespace

int learn_experience(const ExperienceOptions& options, std::ostream& out, std::ostream& remarks) {
  const auto pool = sim::make_pool(options.training.threads);
  const erp::Robot robot = erp::read_robot(options.robot);
  auto task = xml::read<Task>(options.task);
  if (options.seed != 0) task.seed = options.seed;
  ExperienceTraining training(robot, task, task_poses(options.task, task.starts, robot));
  TrainingRunOptions run = options.training;
  run.rounds = task.rounds;
  if (!run_training(training, run, *pool, remarks)) return 1;
  if (pool->first()) write_file(run.folder + "/base.xml", training.state());
  Tests tests(training, robot, task);
  if (!tests.run(options, *pool, remarks)) return 1;
  if (!pool->first()) return 0;
  if (options.tests > 0) {
    write_file(run.folder + "/tests.csv", csv_of(tests));
    draw(figure(tests), run.folder + "/figure.svg");
    print_offsets(tests, out);
  }
  if (training.tripped() > 0)
    out << fmt::format("{} trials ended by an ECU that tripped; they are not in the base\n",
                       training.tripped());
  out << fmt::format("{0}/base.xml is the base for the component experience\n", run.folder);
  return 0;
}

}  // namespace launch
