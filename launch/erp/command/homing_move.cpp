#include "launch/erp/command/homing_move.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <ostream>
#include <stdexcept>

#include "components/node/clock.hpp"
#include "interfaces/emergency.hpp"

namespace launch {
namespace {

constexpr std::int64_t second_ns = 1'000'000'000;
constexpr std::int64_t window_ns = second_ns;  // chosen: of the rest
constexpr double rest_m = 0.0003;              // chosen: largest movement of a line at rest
constexpr double timeout_s = 30;               // chosen
constexpr double min_follow = 0.5;  // chosen: share of the tension below which a line is slack
constexpr double mean_s = 0.2;      // chosen: snapshots are means over this time

double to_s(std::int64_t ns) { return 1e-9 * static_cast<double>(ns); }

}  // namespace

void HomingMove::send(const std::vector<double>& tension_N) {
  std::vector<erp::ActuatorReference> references;
  for (std::size_t a = 0; a < model_.actuators.size(); ++a) {
    const std::string& name = model_.actuators[a].name;
    if (std::ranges::find(names_, name) == names_.end()) continue;
    erp::ActuatorReference& reference = references.emplace_back();
    erp::assign(reference.name, name);
    reference.mode = static_cast<std::uint8_t>(erp::Mode::force);
    reference.reference = tension_N[a];
  }
  link_.command(model_.name, references, priority_);
}

void HomingMove::hold() { send(last_N_); }

void HomingMove::release() {
  link_.command(model_.name, names_, erp::release_mode, 0, priority_);
  link_.watch(second_ns / 20, [] { return false; });  // until the release has been delivered
}

sim::HomingSnapshot HomingMove::measure() const {
  const auto& robot = link_.robot(model_.name);
  sim::HomingSnapshot snapshot;
  for (const auto& actuator : model_.actuators) {
    const auto* sample = robot.sample(actuator.name);
    if (!sample)
      throw std::runtime_error("the running robot has no actuator \"" + actuator.name +
                               "\"; give the robot.xml that it runs with: --xml");
    snapshot.line_m.push_back(sample->line_m);
    snapshot.tension_N.push_back(sample->valid & erp::valid::tension ? sample->tension_N : 0);
  }
  for (const auto& sensor : model_.joint_sensors) {
    auto& angle = snapshot.joint_rad.emplace_back();
    for (const auto& sample : erp::samples(robot.frame.joints))
      if (erp::sample_name(sensor) == sample.name && (sample.valid & erp::valid::joint_angle))
        angle = sample.angle_rad;
  }
  return snapshot;
}

/// The mean of the newest rows; joint angles without a valid reading in one of them stay invalid.
sim::HomingSnapshot HomingMove::mean() const {
  sim::HomingSnapshot sum = rows_.back().snapshot;
  double count = 1;
  for (std::size_t k = rows_.size() - 1; k-- > 0;) {
    if (to_s(rows_.back().time_ns - rows_[k].time_ns) > mean_s) break;
    const auto& added = rows_[k].snapshot;
    for (std::size_t a = 0; a < sum.line_m.size(); ++a)
      sum.line_m[a] += added.line_m[a], sum.tension_N[a] += added.tension_N[a];
    for (std::size_t s = 0; s < sum.joint_rad.size(); ++s)
      sum.joint_rad[s] = sum.joint_rad[s] && added.joint_rad[s]
                             ? std::optional(*sum.joint_rad[s] + *added.joint_rad[s])
                             : std::nullopt;
    ++count;
  }
  for (auto* values : {&sum.line_m, &sum.tension_N})
    for (double& value : *values) value /= count;
  for (auto& angle : sum.joint_rad)
    if (angle) *angle /= count;
  return sum;
}

double HomingMove::moved_m() const {
  double moved = 0;
  for (std::size_t a = 0; a < model_.actuators.size(); ++a) {
    const auto line = [a](const Row& row) { return row.snapshot.line_m[a]; };
    const auto [low, high] = std::ranges::minmax(rows_, {}, line);
    moved = std::max(moved, line(high) - line(low));
  }
  return moved;
}

std::string HomingMove::obstacle() const {
  const auto& robot = link_.robot(model_.name);
  for (const auto& name : names_) {
    const auto* owner = robot.owner(name);
    const auto* sample = robot.sample(name);
    if (!owner || !sample) continue;
    if (owner->owner[0] && link_.controller() != owner->owner)
      return fmt::format("{} is driven by {} with priority {}; raise --priority", name,
                         owner->owner, owner->priority);
    if (sample->ecu_state == static_cast<std::uint8_t>(erp::EcuState::fault))
      return fmt::format("{0}: its ECU has switched off with fault {1}; erp send {0} off clears it",
                         name, sample->ecu_fault);
  }
  return "";
}

std::string HomingMove::slack_line(const sim::HomingSnapshot& snapshot) const {
  for (std::size_t a = 0; a < model_.actuators.size(); ++a) {
    const std::string& name = model_.actuators[a].name;
    if (std::ranges::find(names_, name) == names_.end() ||
        snapshot.tension_N[a] >= min_follow * last_N_[a])
      continue;
    return fmt::format(
        "{}: {:.1f} N instead of {:.1f} N; check its line, its tension sensor and the events of "
        "the "
        "plant",
        name, snapshot.tension_N[a], last_N_[a]);
  }
  return "";
}

sim::HomingSnapshot HomingMove::pass(const std::vector<double>& tension_N, bool until_rest) {
  const std::vector<double> from_N =
      last_N_.empty() ? std::vector<double>(tension_N.size(), 0.0) : std::exchange(last_N_, {});
  const std::int64_t began_ns = node::monotonic_ns();
  std::uint64_t last_sequence = 0;
  bool is_done = false;
  std::string problem;
  rows_.clear();
  const bool is_running = link_.watch(static_cast<std::int64_t>(timeout_s * second_ns), [&] {
    const auto now_ns = node::monotonic_ns();
    const double time_s = to_s(now_ns - began_ns);
    last_N_ = from_N;
    for (std::size_t a = 0; a < tension_N.size(); ++a)
      last_N_[a] += std::min(1.0, time_s / ramp_s) * (tension_N[a] - from_N[a]);
    send(last_N_);
    problem = time_s > 1 ? obstacle() : "";
    const auto sequence = link_.robot(model_.name).frame.sequence;
    if (!problem.empty() || std::exchange(last_sequence, sequence) == sequence)
      return !problem.empty();
    rows_.push_back({now_ns, measure()});
    while (now_ns - rows_.front().time_ns > window_ns) rows_.pop_front();
    is_done = time_s > hold_s && (!until_rest || moved_m() < rest_m);
    return is_done;
  });
  if (is_done) return mean();
  if (!problem.empty()) throw std::runtime_error(problem);
  if (!is_running) throw std::runtime_error("interrupted: the zeros are as before");
  throw std::runtime_error(fmt::format(
      "the robot did not come to rest within {:.0f} s; hold it, or give a lower --tension",
      timeout_s));
}

sim::HomingSnapshot HomingMove::rest(double tension_N) {
  try {
    const auto snapshot = pass(std::vector(model_.actuators.size(), tension_N), true);
    if (const auto problem = slack_line(snapshot); !problem.empty())
      throw std::runtime_error(problem);
    return snapshot;
  } catch (...) {
    release();
    throw;
  }
}

std::vector<sim::HomingSnapshot> HomingMove::follow(const std::vector<std::vector<double>>& sets,
                                                    std::ostream& out) {
  std::vector<sim::HomingSnapshot> snapshots;
  try {
    for (const auto& set : sets) {
      out << fmt::format("pose {} of {}, {:.0f} s left\n", snapshots.size() + 1, sets.size(),
                         hold_s * static_cast<double>(sets.size() - snapshots.size()))
          << std::flush;
      snapshots.push_back(pass(set, false));
    }
  } catch (...) {
    release();
    throw;
  }
  return snapshots;
}

}  // namespace launch
