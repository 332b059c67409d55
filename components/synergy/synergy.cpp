#include "components/synergy/synergy.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include "components/node/ask.hpp"
#include "interfaces/xml/document.hpp"
#include "sim/learning/training_loop/dice.hpp"
#include "sim/learning/training_loop/keep.hpp"

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
  line_m_ = start_m_ = Eigen::VectorXd::Zero(std::ssize(muscles_));
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

/// First of all, and where the robot may have been left on its own.
void Synergy::lead_back(double dt_s) {
  if (trial_)
    node_.report(erp::Severity::warning, target(), "begun_again",
                 fmt::format("no frames for {:.2f} s", dt_s));
  trial_.reset();
  way_.emplace(file_.times, time_s_, line_m_);
}

/// True as well where nobody says where the hand is.
bool Synergy::in_place(const std::optional<Vec3>& hand_m) {
  const double off_m = hand_m ? (*hand_m - sim::vec(file_.rest_m)).norm() : 0;
  const bool in_place = off_m <= back_m;
  if (!in_place && !waiting_)
    node_.report(erp::Severity::warning, target(), "displaced",
                 fmt::format("the hand is {:.0f} mm from where plans were learnt to begin, at most "
                             "{:.0f} are allowed: no plan begins until the robot is set right",
                             1e3 * off_m, 1e3 * back_m));
  waiting_ = !in_place;
  return in_place;
}

void Synergy::begin() {
  Blend blend = bank_.blend(sim::vec(params_.targets[target_].at_m));
  credits_ = std::move(blend.credits), seen_ = true;
  trial_.emplace(std::move(blend.plan), file_.times, params_.noise,
                 sim::training_loop::dice(static_cast<std::uint64_t>(params_.seed), target_)());
}

void Synergy::watch(const std::optional<Vec3>& hand_m) {
  if (hand_m) trial_->see(time_s_, *hand_m);
  seen_ = seen_ && hand_m;
  if (trial_->done()) end();
}

void Synergy::end() {
  if (seen_) {
    Taught taught = taught_by(*trial_, file_.bottle, sim::vec(file_.rest_m),
                              sim::vec(params_.targets[target_].at_m));
    tell(taught);
    if (!params_.save.empty()) learn(std::move(taught));
  } else {
    node_.report(erp::Severity::info, target(), "tried",
                 "not judged: \"" + params_.source + "\" did not say where the hand was");
  }
  trial_.reset();
  node_.show("targets", static_cast<double>(++target_));
  if (target_ == params_.targets.size())
    node_.report(erp::Severity::info, "targets", "done", "all are tried");
}

void Synergy::tell(const Taught& taught) {
  const Outcome& outcome = taught.outcome;
  ++judged_, struck_ += outcome.struck;
  const char* said = outcome.struck ? "struck" : "missed";
  node_.report(erp::Severity::info, target(), said,
               fmt::format("{}, {:.0f} mm between hand and bottle at the nearest, reward {:.2f}, "
                           "came back to {:.0f} mm; {} of {} struck",
                           said, 1e3 * outcome.nearest_m, outcome.reward, 1e3 * taught.off_m,
                           struck_, judged_));
}

void Synergy::learn(Taught taught) {
  bank_.credit(credits_, taught.credit);
  if (taught.plan) bank_.add(std::move(*taught.plan));
  bank_.trim();
  node::write_or_report(
      node_, xml::resolved(params_.save, params_.place.file),
      [&](const std::string& file) { sim::training_loop::keep(file, text_of(file_, bank_)); });
}

erp::ActuatorCommand Synergy::step(const erp::SensorFrame& frame, double dt_s,
                                   const node::Latest<erp::BodyPose>& bodies) {
  constexpr double most_gap_s = 0.1;  // without frames; chosen
  read(frame);
  time_s_ += dt_s;
  if (!begun_ || dt_s > most_gap_s) begun_ = true, lead_back(dt_s);
  const auto hand = hand_m(bodies);
  if (trial_) watch(hand);
  if (way_ && way_->done(time_s_)) way_.reset();
  if (!way_ && !trial_ && target_ < params_.targets.size() && in_place(hand)) begin();
  if (way_) return command(way_->at(time_s_));
  return command(trial_ ? trial_->step(time_s_) : start_m_);
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
