#include "components/experience/experience.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "components/node/controller_helpers.hpp"
#include "interfaces/xml/document.hpp"
#include "sim/learning/training_loop/checkpoint.hpp"

namespace control {
namespace {

/// Chosen: after a longer gap without frames the position of the robot is unknown.
constexpr double max_frame_gap_s = 0.1;

using namespace sim::experience;
using sim::Vec3;

BaseFile checked_base(const Experience::Params& params, const erp::Robot& robot) {
  auto file = xml::read<BaseFile>(xml::resolved(params.base, params.place.file));
  check(file, std::ssize(robot.actuators));
  return file;
}

std::shared_ptr<const Feedback> feedback(const Experience::Params& params, const Base& base,
                                         int start, const Vec3& target_m) {
  if (params.feedback == FeedbackKind::linear)
    return linear_feedback(base, start, target_m, params.feedback_gain_per_s);
  if (params.feedback == FeedbackKind::fuzzy)
    return fuzzy_feedback(base, start, xml::resolved(params.rules, params.place.file));
  return nullptr;
}

std::string offset_text_mm(const std::optional<Vec3>& at_m, const Vec3& target_m) {
  if (!at_m) return "unknown";
  const Vec3 offset_mm = 1e3 * (*at_m - target_m);
  return fmt::format("{:+.2f} {:+.2f} {:+.2f} mm", offset_mm.x(), offset_mm.y(), offset_mm.z());
}

}  // namespace

Experience::Experience(const Params& params, const erp::Robot& robot, node::Node& node)
    : params_(params),
      robot_(robot),
      node_(node),
      names_(robot),
      skeleton_(sim::RobotTree(robot), sim::vec(robot.gravity_m_per_s2())),
      file_(checked_base(params, robot)),
      base_(base_of(file_)),
      hand_(file_.hand, sim::RobotTree(robot).names),
      motors_(robot) {
  for (const erp::Joint& joint : names_.list()) joints_.push_back(sim::initial_reading(joint));
  line_m_ = tension_N_ = Eigen::VectorXd::Zero(std::ssize(robot.actuators));
  feedback(params_, base_, 0, Vec3::Zero());  // reports errors of the rules file at start-up
}

/// A signal that was not measured keeps its last value. The plant does not drive its actuator.
void Experience::read_measurements(const erp::SensorFrame& frame) {
  for (std::size_t m = 0; const erp::ActuatorSample& sample : erp::samples(frame.actuators)) {
    const auto muscle = static_cast<Eigen::Index>(m++);
    if (muscle >= line_m_.size()) return;
    if (sample.valid & erp::valid::line) line_m_[muscle] = sample.line_m;
    if (sample.valid & erp::valid::tension) tension_N_[muscle] = sample.tension_N;
  }
}

std::optional<Vec3> Experience::hand_m(const erp::SensorFrame& frame,
                                       const node::Latest<erp::JointState>& joints) {
  if (!joints || joints.age_s > params_.stale_s ||
      !names_.read(joints.message, frame.stamp_ns, joints_))
    return std::nullopt;
  skeleton_.place(joints_);
  return hand_.in(skeleton_.poses());
}

int Experience::nearest_start() const {
  const auto squared_distance = [&](const StartRow& start) {
    return (Eigen::Map<const Eigen::VectorXd>(start.line_m.data(), line_m_.size()) - line_m_)
        .squaredNorm();
  };
  return static_cast<int>(std::ranges::min_element(file_.starts.all, {}, squared_distance) -
                          file_.starts.all.begin());
}

void Experience::begin_reach() {
  const Vec3 target_m = sim::vec(params_.goals[goal_].at_m);
  start_ = nearest_start();
  const Eigen::VectorXd desired_Vs = base_.inverse(start_, target_m);
  if (const double peak = peak_V(file_, desired_Vs); peak > file_.pattern_V)
    node_.report(
        erp::Severity::warning, "goal " + std::to_string(goal_ + 1), "out_of_reach",
        fmt::format(
            "needs {:.1f} V at a muscle; all voltages are scaled down to at most {:.1f} V. The "
            "goal lies outside the experience; train the base nearer to it",
            peak, file_.pattern_V));
  reach_.emplace(reach_with(file_, start_, target_m, within_voltage(file_, desired_Vs),
                            feedback(params_, base_, start_, target_m)));
}

void Experience::end_reach() {
  report_reached();
  if (const auto& settled_m = reach_->settled_m())
    base_.add({start_, reach_->plan().scales_Vs, *settled_m});
  save_base();
  ++goal_;
  node_.show("goals", static_cast<double>(goal_));
  if (goal_ == params_.goals.size())
    node_.report(erp::Severity::info, "goals", "done", "all goals are finished; the gears hold");
}

void Experience::report_reached() {
  const Vec3& target_m = reach_->plan().target_m;
  const std::string goal = "goal " + std::to_string(goal_ + 1);
  node_.report(erp::Severity::info, goal, "reached",
               fmt::format("offset {} before feedback, {} after it",
                           offset_text_mm(reach_->settled_m(), target_m),
                           reach_->plan().feedback ? offset_text_mm(reach_->corrected_m(), target_m)
                                                   : "no feedback"));
  if (reach_->limited())
    node_.report(erp::Severity::warning, goal, "limited",
                 fmt::format("feedback exceeded {:.1f} V at a drive and was scaled down",
                             file_.times.feedback_V));
}

erp::ActuatorCommand Experience::step(const erp::SensorFrame& frame, double dt_s,
                                      const node::Latest<erp::JointState>& joints) {
  read_measurements(frame);
  time_s_ += dt_s;
  if (reach_ && dt_s > max_frame_gap_s && goal_ < params_.goals.size()) {
    node_.report(erp::Severity::warning, "goal " + std::to_string(goal_ + 1), "restarted",
                 fmt::format("no frames for {:.2f} s; the reach restarts", dt_s));
    reach_.reset();
  }
  if ((!reach_ || reach_->done()) && goal_ < params_.goals.size()) {
    if (reach_) end_reach();
    if (goal_ < params_.goals.size()) begin_reach();
  }
  if (!reach_) return command({false, Eigen::VectorXd::Zero(line_m_.size())});
  const auto hand = hand_m(frame, joints);
  if (!hand && !unknown_reported_) {
    unknown_reported_ = true;
    node_.report(
        erp::Severity::warning, params_.source, "no_joint_state",
        "its joint_state is missing, stale or lacks a joint; no correction until it is complete");
  }
  if (hand) unknown_reported_ = false;
  return command(reach_->step(time_s_, line_m_, hand));
}

erp::ActuatorCommand Experience::command(const MuscleCommand& desired) const {
  erp::ActuatorCommand command;
  for (std::size_t m = 0; m < robot_.actuators.size(); ++m) {
    const auto [mode, reference] =
        motors_.ecu_reference(m, desired, tension_N_[static_cast<Eigen::Index>(m)]);
    node::append_reference(command, robot_.actuators[m].name, mode, reference);
  }
  return command;
}

void Experience::save_base() const {
  if (params_.save.empty()) return;
  BaseFile checkpoint = file_;
  checkpoint.experiences.all = rows_of(base_);
  node::write_or_report(node_, xml::resolved(params_.save, params_.place.file),
                        [&](const std::string& file) {
                          sim::training_loop::write_checkpoint(file, xml::write(checkpoint));
                        });
}

}  // namespace control
