#include "components/sensorimotor/sensorimotor.hpp"

#include <fmt/format.h>

#include "components/node/controller_helpers.hpp"
#include "interfaces/xml/document.hpp"
#include "sim/learning/sensorimotor/learned_map_file.hpp"
#include "sim/learning/training_loop/checkpoint.hpp"

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
  if (params.learned.empty()) return {options, LearnedMap(eye.senses(), muscles), std::move(goals)};
  options.twitches = 0;
  const auto file = xml::read<LearnedMapFile>(xml::resolved(params.learned, params.place.file));
  auto earlier_goals = goals_of(file, eye.senses());
  for (Goal& goal : earlier_goals) goal.errors.clear();
  return {options, learned_map_of(file, eye.senses(), muscles), std::move(earlier_goals)};
}

}  // namespace

Sensorimotor::Sensorimotor(const Params& params, const erp::Robot& robot, node::Node& node)
    : params_(params),
      robot_(robot),
      node_(node),
      eye_(eye_of(params, robot)),
      session_(session_of(params, robot, eye_)) {}

/// Uses the largest spot of each camera. Skips the instant if a camera has no spot.
void Sensorimotor::on_image(const erp::ImagePoint& points) {
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
  if (points && points->stamp_ns != last_image_ns_ && points.age_s <= params_.stale_s)
    last_image_ns_ = points->stamp_ns, on_image(points.message);
  const Eigen::VectorXd& motors_N = session_.motors_N(time_s_);
  erp::ActuatorCommand command;
  for (std::size_t a = 0; a < robot_.actuators.size(); ++a) {
    node::append_reference(
        command, robot_.actuators[a].name, erp::Mode::force,
        robot_.actuators[a].tendon.pretension_N + motors_N[static_cast<Eigen::Index>(a)]);
  }
  report_progress();
  return command;
}

void Sensorimotor::report_progress() {
  const auto& goals = session_.goals();
  const auto trials = static_cast<std::size_t>(params_.experiment.session.trials);
  while (goals_reported_ < goals.size() && trials > 0 &&
         goals[goals_reported_].errors.size() == trials) {
    const auto& errors = goals[goals_reported_++].errors;
    node_.report(erp::Severity::info, "goal " + std::to_string(goals_reported_), "finished",
                 fmt::format("{} of {}: error {:.4f} in the first trial, {:.4f} in the last",
                             goals_reported_, goals.size(), errors.front(), errors.back()));
    node_.show("goals", static_cast<double>(goals_reported_));
    save_map();
  }
  if (session_.unseen() > 0 && !unseen_reported_) {
    unseen_reported_ = true;
    node_.report(
        erp::Severity::warning, params_.source, "marker_not_seen",
        "the marker was not seen during the averaging time; trials restart. Check that the graph "
        "has an eye and that the marker is in all of its images");
  }
  if (session_.limited() > 0 && !limited_reported_) {
    limited_reported_ = true;
    node_.report(erp::Severity::warning, "most_N", "limited",
                 fmt::format("a trial exceeded {:.0f} N above rest at a muscle; all its forces are "
                             "scaled down to that limit. The goal may be out of reach",
                             params_.experiment.session.most_N));
  }
  if (session_.done() && !done_reported_) {
    done_reported_ = true;
    node_.report(erp::Severity::info, "session", "done",
                 "all goals are finished; the muscles rest");
    save_map();
  }
}

void Sensorimotor::save_map() const {
  if (params_.save.empty()) return;
  node::write_or_report(node_, xml::resolved(params_.save, params_.place.file),
                        [&](const std::string& file) {
                          sim::training_loop::write_checkpoint(
                              file, xml::write(file_of(session_.learned(), session_.goals())));
                        });
}

}  // namespace control
