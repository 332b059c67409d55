#include "components/synergy/synergy.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include "components/node/controller_helpers.hpp"
#include "interfaces/xml/document.hpp"
#include "sim/learning/training_loop/checkpoint.hpp"
#include "sim/learning/training_loop/random_stream.hpp"

namespace control {
namespace {

using namespace sim::synergy;
using sim::Vec3;

constexpr double max_frame_gap_s = 0.1;  // chosen: after a longer gap the trial restarts

BankFile checked_bank(const Synergy::Params& params) {
  auto file = xml::read<BankFile>(xml::resolved(params.bank, params.place.file));
  check(file);
  return file;
}

}  // namespace

Synergy::Synergy(const Params& params, const erp::Robot& robot, node::Node& node)
    : params_(params),
      robot_(robot),
      node_(node),
      file_(checked_bank(params)),
      bank_(bank_of(file_)),
      muscles_(actuators_of(file_.muscles.all, robot)),
      all_line_m_(robot.actuators.size()) {
  line_m_ = start_m_ = Eigen::VectorXd::Zero(std::ssize(muscles_));
}

void Synergy::read_lines(const erp::SensorFrame& frame) {
  for (std::size_t a = 0; const erp::ActuatorSample& sample : erp::samples(frame.actuators)) {
    if (a == all_line_m_.size()) break;
    if (sample.valid & erp::valid::line) all_line_m_[a] = sample.line_m;
    ++a;
  }
  for (std::size_t m = 0; m < muscles_.size(); ++m)
    line_m_[static_cast<Eigen::Index>(m)] = all_line_m_[muscles_[m]];
}

std::optional<Vec3> Synergy::hand_m(const node::Latest<erp::BodyPose>& bodies) const {
  if (!bodies || bodies.age_s > params_.stale_s) return std::nullopt;
  for (const erp::BodyPoseSample& body : erp::samples(bodies.message.bodies)) {
    if (file_.hand.body != body.name) continue;
    const double* q = body.orientation_wxyz;
    return Vec3(body.position_m[0], body.position_m[1], body.position_m[2]) +
           Eigen::Quaterniond(q[0], q[1], q[2], q[3]) * sim::vec(file_.hand.at_m);
  }
  return std::nullopt;
}

/// Returns the lines to the start: at the beginning, and after a gap in the frames.
void Synergy::begin_return(double dt_s) {
  if (trial_)
    node_.report(erp::Severity::warning, target(), "restarted",
                 fmt::format("no frames for {:.2f} s; the trial restarts", dt_s));
  trial_.reset();
  return_path_.emplace(file_.times, time_s_, line_m_);
}

/// True if the hand is at the start position or its position is unknown.
bool Synergy::is_at_start(const std::optional<Vec3>& hand_m) {
  const double distance_m = hand_m ? (*hand_m - sim::vec(file_.rest_m)).norm() : 0;
  const bool at_start = distance_m <= back_m;
  if (!at_start && !displaced_)
    node_.report(
        erp::Severity::warning, target(), "displaced",
        fmt::format(
            "the hand is {:.0f} mm from the start position of the training, at most {:.0f} mm are "
            "allowed; no plan begins until the robot is repositioned",
            1e3 * distance_m, 1e3 * back_m));
  displaced_ = !at_start;
  return at_start;
}

void Synergy::begin_trial() {
  Blend blend = bank_.blend(sim::vec(params_.targets[target_].at_m));
  credits_ = std::move(blend.credits), hand_was_known_ = true;
  trial_.emplace(
      std::move(blend.plan), file_.times, params_.noise,
      sim::training_loop::random_stream(static_cast<std::uint64_t>(params_.seed), target_)());
}

void Synergy::track_hand(const std::optional<Vec3>& hand_m) {
  if (hand_m) trial_->see(time_s_, *hand_m);
  hand_was_known_ = hand_was_known_ && hand_m;
  if (trial_->done()) end_trial();
}

void Synergy::end_trial() {
  if (hand_was_known_) {
    TrialResult result = result_of(*trial_, file_.bottle, sim::vec(file_.rest_m),
                                   sim::vec(params_.targets[target_].at_m));
    report_result(result);
    if (!params_.save.empty()) learn(std::move(result));
  } else {
    node_.report(erp::Severity::info, target(), "finished",
                 "not evaluated: \"" + params_.source + "\" did not report the hand position");
  }
  trial_.reset();
  node_.show("targets", static_cast<double>(++target_));
  if (target_ == params_.targets.size())
    node_.report(erp::Severity::info, "targets", "done", "all targets are finished");
}

void Synergy::report_result(const TrialResult& result) {
  const Outcome& outcome = result.outcome;
  ++evaluated_, struck_ += outcome.struck;
  const char* outcome_name = outcome.struck ? "struck" : "missed";
  node_.report(
      erp::Severity::info, target(), outcome_name,
      fmt::format(
          "{}: smallest distance of hand and bottle {:.0f} mm, reward {:.2f}, distance from the "
          "start after the return {:.0f} mm; {} of {} struck",
          outcome_name, 1e3 * outcome.nearest_m, outcome.reward, 1e3 * result.off_m, struck_,
          evaluated_));
}

void Synergy::learn(TrialResult result) {
  bank_.credit(credits_, result.credit);
  if (result.plan) bank_.add(std::move(*result.plan));
  bank_.trim();
  node::write_or_report(node_, xml::resolved(params_.save, params_.place.file),
                        [&](const std::string& file) {
                          sim::training_loop::write_checkpoint(file, text_of(file_, bank_));
                        });
}

erp::ActuatorCommand Synergy::step(const erp::SensorFrame& frame, double dt_s,
                                   const node::Latest<erp::BodyPose>& bodies) {
  read_lines(frame);
  time_s_ += dt_s;
  if (!has_begun_ || dt_s > max_frame_gap_s) has_begun_ = true, begin_return(dt_s);
  const auto hand = hand_m(bodies);
  if (trial_) track_hand(hand);
  if (return_path_ && return_path_->done(time_s_)) return_path_.reset();
  if (!return_path_ && !trial_ && target_ < params_.targets.size() && is_at_start(hand))
    begin_trial();
  if (return_path_) return command(return_path_->at(time_s_));
  return command(trial_ ? trial_->step(time_s_) : start_m_);
}

/// Lines of muscles without a weight keep their length at the start.
erp::ActuatorCommand Synergy::command(const Eigen::VectorXd& line_m) const {
  std::vector<double> desired_m(robot_.actuators.size());
  for (std::size_t m = 0; m < muscles_.size(); ++m)
    desired_m[muscles_[m]] = line_m[static_cast<Eigen::Index>(m)];
  erp::ActuatorCommand command;
  for (std::size_t a = 0; a < desired_m.size(); ++a) {
    node::append_reference(command, robot_.actuators[a].name, erp::Mode::length, desired_m[a]);
  }
  return command;
}

}  // namespace control
