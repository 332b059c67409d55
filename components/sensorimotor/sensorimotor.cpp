#include "components/sensorimotor/sensorimotor.hpp"

#include <fmt/format.h>

#include "components/node/ask.hpp"
#include "interfaces/xml/document.hpp"
#include "sim/learning/training_loop/keep.hpp"
#include "sim/learning/sensorimotor/learnt_file.hpp"

namespace control {
namespace {

using namespace sim::sensorimotor;

Eye eye_of(const Sensorimotor::Params& params, const erp::Robot& robot) {
  return Eye(
      xml::read<sim::cameras::ViewConfig>(xml::resolved(params.experiment.view, params.place.file)),
      sim::RobotTree(robot));
}

Session session_of(const Sensorimotor::Params& params, const erp::Robot& robot, const Eye& eye) {
  const auto muscles = std::ssize(robot.actuators);
  SessionOptions options = params.experiment.session;
  options.seed = static_cast<std::uint64_t>(params.experiment.seed);
  auto goals = goals_of(params.experiment, eye.senses());
  if (params.learnt.empty()) return {options, Learnt(eye.senses(), muscles), std::move(goals)};
  options.twitches = 0;
  const auto file = xml::read<LearntFile>(xml::resolved(params.learnt, params.place.file));
  auto before = goals_of(file, eye.senses());
  for (Goal& goal : before) goal.errors.clear();
  return {options, learnt_of(file, eye.senses(), muscles), std::move(before)};
}

}  // namespace

Sensorimotor::Sensorimotor(const Params& params, const erp::Robot& robot, node::Node& node)
    : params_(params),
      robot_(robot),
      node_(node),
      eye_(eye_of(params, robot)),
      session_(session_of(params, robot, eye_)) {}

/// The largest spot of each camera; an instant at which one sees none is not seen.
void Sensorimotor::see(const erp::ImagePoint& points) {
  Eigen::VectorXd senses = Eigen::VectorXd::Zero(eye_.senses());
  std::vector<double> largest_px(static_cast<std::size_t>(eye_.senses()) / 2);
  for (const erp::ImagePointSample& point : erp::samples(points.points)) {
    const auto camera = eye_.camera_named(point.camera);
    if (!camera || point.area_px <= largest_px[*camera]) continue;
    largest_px[*camera] = point.area_px;
    senses.segment<2>(2 * static_cast<Eigen::Index>(*camera)) =
        eye_.sense(*camera, {point.u_px, point.v_px});
  }
  for (const double area_px : largest_px)
    if (area_px == 0) return;
  session_.see(time_s_, senses);
}

erp::ActuatorCommand Sensorimotor::step(const erp::SensorFrame& frame, double dt_s,
                                        const node::Latest<erp::ImagePoint>& points) {
  time_s_ += dt_s;
  const double age_s = 1e-9 * static_cast<double>(frame.stamp_ns - points->stamp_ns);
  if (points && points->stamp_ns != seen_ns_ && age_s <= params_.stale_s)
    seen_ns_ = points->stamp_ns, see(points.message);
  const Eigen::VectorXd& motors_N = session_.motors_N(time_s_);
  erp::ActuatorCommand command;
  for (std::size_t a = 0; a < robot_.actuators.size(); ++a) {
    node::ask(command, robot_.actuators[a].name, erp::Mode::force,
              robot_.actuators[a].tendon.pretension_N + motors_N[static_cast<Eigen::Index>(a)]);
  }
  tell();
  return command;
}

void Sensorimotor::tell() {
  const auto& goals = session_.goals();
  const auto tries = static_cast<std::size_t>(params_.experiment.session.tries);
  while (goals_told_ < goals.size() && tries > 0 && goals[goals_told_].errors.size() == tries) {
    const auto& errors = goals[goals_told_++].errors;
    node_.report(erp::Severity::info, "goal " + std::to_string(goals_told_), "tried",
                 fmt::format("{} of {}: error {:.4f} at first, {:.4f} at last", goals_told_,
                             goals.size(), errors.front(), errors.back()));
    node_.show("goals", static_cast<double>(goals_told_));
    write();
  }
  if (session_.blind() > 0 && !blind_told_) {
    blind_told_ = true;
    node_.report(erp::Severity::warning, params_.source, "blind",
                 "nothing is seen where it matters: tries are begun again; is there an eye in the "
                 "graph, and the marker in all of its images?");
  }
  if (session_.limited() > 0 && !limited_told_) {
    limited_told_ = true;
    node_.report(
        erp::Severity::warning, "most_N", "limited",
        fmt::format("a try asked a muscle for more than {:.0f} N above rest: all its forces "
                    "are scaled down to that; the goal may be out of reach",
                    params_.experiment.session.most_N));
  }
  if (session_.done() && !done_told_) {
    done_told_ = true;
    node_.report(erp::Severity::info, "session", "done", "all goals are tried; the muscles rest");
    write();
  }
}

void Sensorimotor::write() const {
  if (params_.save.empty()) return;
  node::write_or_report(
      node_, xml::resolved(params_.save, params_.place.file), [&](const std::string& file) {
        sim::training_loop::keep(file, xml::write(file_of(session_.learnt(), session_.goals())));
      });
}

}  // namespace control
