#include "components/synergy/synergy.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>

#include <filesystem>

#include "sim/learner/dice.hpp"
#include "sim/learner/keep.hpp"

namespace control {
namespace {

namespace fs = std::filesystem;
using namespace sim::synergy;
using sim::Vec3;

std::string beside(const Synergy::Params& params, const std::string& file) {
  return (fs::path(params.place.file).parent_path() / file).string();
}

BankFile checked_bank(const Synergy::Params& params) {
  auto file = xml::read<BankFile>(beside(params, params.bank));
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
  credits_ = std::move(blend.credits), seen_ = true, watched_ = false;
  trial_.emplace(std::move(blend.plan), file_.times, params_.noise,
                 sim::learner::dice(static_cast<std::uint64_t>(params_.seed), target_)());
}

/// A torso of floating bones may rest in more than one way with the same lines.
void Synergy::begin_watching(const Vec3& hand_m) {
  constexpr double most_m = 0.02;  // chosen
  watched_ = true;
  const double off_m = (hand_m - sim::vec(file_.rest_m)).norm();
  if (off_m > most_m)
    node_.report(erp::Severity::warning, "target " + std::to_string(target_ + 1), "displaced",
                 fmt::format("the hand begins {:.0f} mm from where plans were learnt to begin: the "
                             "robot has not come back; set it right, or what follows will miss",
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
    learn(outcome);
  } else {
    node_.report(erp::Severity::info, name, "tried",
                 "not judged: \"" + params_.source + "\" did not say where the hand was");
  }
  node_.show("targets", static_cast<double>(target_));
  if (target_ == params_.targets.size())
    node_.report(erp::Severity::info, "targets", "done", "all are tried; the lines go back");
}

void Synergy::learn(const Outcome& outcome) {
  if (params_.save.empty()) return;
  bank_.credit(credits_, outcome.reward);
  MotorPlan plan = trial_->plan();
  plan.at_m = rest_of(trial_->path());
  plan.value = judge(file_.bottle, plan.at_m, trial_->path(), trial_->end_s()).reward;
  bank_.add(std::move(plan)), bank_.trim();
  BankFile all = file_;
  all.plans.all = rows_of(bank_);
  const std::string file = beside(params_, params_.save);
  try {
    sim::learner::keep(file, xml::write(all));
  } catch (const std::exception& e) {
    node_.report(erp::Severity::fault, file, "unwritten", e.what());
  }
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
    erp::ActuatorReference one{};
    erp::assign(one.name, robot_.actuators[a].name);
    one.mode = static_cast<std::uint8_t>(erp::Mode::length);
    one.reference = wanted_m[a];
    erp::append(command.actuators, one);
  }
  return command;
}

}  // namespace control
