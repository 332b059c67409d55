#include "components/synergy/synergy.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include "components/node/ask.hpp"
#include "interfaces/xml/document.hpp"
#include "sim/learner/dice.hpp"
#include "sim/learner/keep.hpp"

namespace control {
namespace {

using namespace sim::synergy;
using sim::Vec3;

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
  line_m_ = Eigen::VectorXd::Zero(std::ssize(muscles_));
}

void Synergy::read(const erp::SensorFrame& frame) {
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

void Synergy::begin() {
  Blend blend = bank_.blend(sim::vec(params_.targets[target_].at_m));
  credits_ = std::move(blend.credits), seen_ = true, watched_ = displaced_ = false;
  trial_.emplace(std::move(blend.plan), file_.times, params_.noise,
                 sim::learner::dice(static_cast<std::uint64_t>(params_.seed), target_)());
}

/// A torso of floating bones may rest in more than one way with the same lines.
void Synergy::begin_watching(const Vec3& hand_m) {
  constexpr double most_m = 0.02;  // chosen
  watched_ = true;
  const double off_m = (hand_m - sim::vec(file_.rest_m)).norm();
  displaced_ = off_m > most_m;
  if (displaced_)
    node_.report(
        erp::Severity::warning, "target " + std::to_string(target_ + 1), "displaced",
        fmt::format(
            "the hand begins {:.0f} mm from where plans were learnt to begin: the "
            "robot has not come back; set it right, or it will miss; this is not learnt from",
            1e3 * off_m));
}

void Synergy::end() {
  const std::string name = "target " + std::to_string(target_ + 1);
  const Vec3 at_m = sim::vec(params_.targets[target_++].at_m);
  if (seen_) {
    const Outcome outcome = judge(file_.bottle, at_m, trial_->path(), trial_->end_s());
    ++judged_, struck_ += outcome.struck;
    node_.report(erp::Severity::info, name, outcome.struck ? "struck" : "missed",
                 fmt::format("{}, {:.0f} mm between hand and bottle at the nearest, reward {:.2f}; "
                             "{} of {} struck",
                             outcome.struck ? "struck" : "missed", 1e3 * outcome.nearest_m,
                             outcome.reward, struck_, judged_));
    learn(outcome, at_m);
  } else {
    node_.report(erp::Severity::info, name, "tried",
                 "not judged: \"" + params_.source + "\" did not say where the hand was");
  }
  node_.show("targets", static_cast<double>(target_));
  if (target_ == params_.targets.size())
    node_.report(erp::Severity::info, "targets", "done", "all are tried; the lines go back");
}

/// A trial that began elsewhere tells nothing of those that begin at rest.
void Synergy::learn(const Outcome& outcome, const Vec3& target_m) {
  if (params_.save.empty() || displaced_) return;
  bank_.credit(credits_, outcome.reward);
  bank_.add(as_it_led(*trial_, file_.bottle, target_m)), bank_.trim();
  BankFile all = file_;
  all.plans.all = rows_of(bank_);
  node::write_or_report(
      node_, xml::resolved(params_.save, params_.place.file),
      [&](const std::string& file) { sim::learner::keep(file, xml::write(all)); });
}

erp::ActuatorCommand Synergy::step(const erp::SensorFrame& frame, double dt_s,
                                   const node::Latest<erp::BodyPose>& bodies) {
  constexpr double most_gap_s =
      0.1;  // without frames: where the robot is now, nobody knows; chosen
  read(frame);
  time_s_ += dt_s;
  if (trial_ && dt_s > most_gap_s && target_ < params_.targets.size()) {
    node_.report(erp::Severity::warning, "target " + std::to_string(target_ + 1), "begun_again",
                 fmt::format("no frames for {:.2f} s", dt_s));
    trial_.reset();
  }
  if (trial_ && trial_->done() && target_ < params_.targets.size()) {
    end();
    if (target_ == params_.targets.size())  // a plan that does nothing leads back
      trial_.emplace(MotorPlan{Eigen::VectorXd::Zero(line_m_.size()), {}, Vec3::Zero()},
                     file_.times, 0.0, 0);
    else trial_.reset();
  }
  if (!trial_ && target_ < params_.targets.size()) begin();
  if (!trial_) return command(Eigen::VectorXd::Zero(line_m_.size()));
  const auto hand = hand_m(bodies);
  if (hand && !watched_ && trial_->planned(time_s_)) begin_watching(*hand);
  if (hand) trial_->see(time_s_, *hand);
  else if (trial_->planned(time_s_)) seen_ = false;
  return command(trial_->step(time_s_, line_m_));
}

/// Muscles that no plan drives stay as long as they were at the start.
erp::ActuatorCommand Synergy::command(const Eigen::VectorXd& line_m) const {
  std::vector<double> wanted_m(robot_.actuators.size());
  for (std::size_t m = 0; m < muscles_.size(); ++m)
    wanted_m[muscles_[m]] = line_m[static_cast<Eigen::Index>(m)];
  erp::ActuatorCommand command;
  for (std::size_t a = 0; a < wanted_m.size(); ++a) {
    node::ask(command, robot_.actuators[a].name, erp::Mode::length, wanted_m[a]);
  }
  return command;
}

}  // namespace control
