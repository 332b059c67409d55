#include <catch2/catch.hpp>

#include "interfaces/robot/robot.hpp"
#include "sim/learning/sensorimotor/experiment.hpp"
#include "sim/learning/sensorimotor/eye.hpp"
#include "sim/learning/sensorimotor/learned_map_file.hpp"
#include "sim/model/skeleton/skeleton_model.hpp"
#include "tests/sim/rigs.hpp"

using namespace sim::sensorimotor;
using Eigen::MatrixXd, Eigen::Vector2d, Eigen::Vector4d, Eigen::VectorXd;

namespace {

/// A linear robot without inertia: senses × muscles, in senses per newton.
const MatrixXd linear =
    (MatrixXd(2, 4) << 0.01, 0.01, -0.01, -0.01, -0.01, 0.01, 0.01, -0.01).finished();

/// Runs a session on a robot without inertia, observed each 10 ms.
void play(Session& session, const MatrixXd& motion_per_N, double shift = 0) {
  for (double t = 0; !session.done(); t += 0.01) {
    const VectorXd senses = motion_per_N * session.motors_N(t) + Vector2d::Constant(shift);
    session.see(t, senses);
  }
}

Session session_with_twitches(std::uint64_t seed = 1) {
  SessionOptions options{.trials = 0, .seed = seed};
  Session session(options, LearnedMap(2, 4), {});
  play(session, linear);
  return session;
}

}  // namespace

TEST_CASE("twitches give the direction of each muscle and the force per sense") {
  const LearnedMap learned = session_with_twitches().learned();
  const MatrixXd q = learned.q();
  for (Eigen::Index s = 0; s < 2; ++s) {
    CHECK(q.row(s).norm() == Approx(1));
    for (Eigen::Index m = 0; m < 4; ++m)  // equal, independent of the number of twitches
      CHECK(q(s, m) == Approx(std::copysign(0.5, linear(s, m))).epsilon(0.01));
  }
  // With α = 1 the goal is reached in the directions that Q spans, without clipping.
  const Vector2d k = learned.force_per_sense_N();
  CHECK((linear.row(0) * q.row(0).transpose())(0) * k[0] == Approx(1).epsilon(1e-3));
  CHECK(learned.motors_N(Vector2d(0, 0), Vector2d(0.1, 0.1)).norm() == 0);
  const VectorXd right = learned.motors_N(Vector2d(1, 1), Vector2d(0.1, 0));
  CHECK(right[0] > 0);
  CHECK(right[2] == 0);  // a muscle cannot push
  CHECK(session_with_twitches(2).learned().hebb() != learned.hebb());
}

TEST_CASE("a goal is reached within 30 trials, and in the first trial the robot does not move") {
  SessionOptions options{.twitches = 0, .trials = 30};
  Session session(options, session_with_twitches().learned(),
                  {{Vector2d(0.2, -0.1), Vector2d(0, 0), {}}});
  play(session, linear, 0.05);
  const Goal& goal = session.goals().front();
  REQUIRE(goal.errors.size() == 30);
  CHECK(goal.errors.front() == Approx(std::hypot(0.15, 0.15)));
  CHECK(goal.errors.back() < 0.02 * goal.errors.front());
  CHECK(session.limited() == 0);
}

TEST_CASE(
    "trials above the force limit are scaled down and counted, and trials without a visible marker "
    "are repeated") {
  SessionOptions options{.twitches = 0, .trials = 30, .most_N = 5};
  Session limited_session(options, session_with_twitches().learned(),
                          {{Vector2d(0.5, 0), Vector2d(0, 0), {}}});
  double largest_N = 0;
  for (double t = 0; !limited_session.done(); t += 0.01) {
    limited_session.see(t, linear * limited_session.motors_N(t));
    largest_N = std::max(largest_N, limited_session.motors_N(t).maxCoeff());
  }
  CHECK(largest_N == Approx(5));
  CHECK(limited_session.limited() > 10);

  options.trials = 1;
  Session unseen(options, session_with_twitches().learned(),
                 {{Vector2d(0.1, 0), Vector2d(0, 0), {}}});
  for (double t = 0; t < 10; t += 0.01) unseen.motors_N(t);
  CHECK_FALSE(unseen.done());
  CHECK(unseen.unseen() == 6);
  CHECK(unseen.goals().front().errors.empty());
}

TEST_CASE("a camera below the pendulum sees its end at the projected position") {
  const erp::Robot robot = erp::read_robot(rigs::config("pendulum/robot.xml"));
  const Eye eye(xml::read<sim::cameras::ViewConfig>(rigs::config("pendulum/view.xml")),
                sim::RobotTree(robot));
  REQUIRE(eye.senses() == 2);
  sim::SkeletonModel model(sim::RobotTree(robot), sim::Vec3::Zero());
  std::vector<sim::JointReading> joints;
  for (const erp::Joint& joint : robot.joints()) joints.push_back(sim::initial_reading(joint));
  const auto senses = [&](double tilt_x, double tilt_y) {
    joints[0].position[0] = tilt_x, joints[1].position[0] = tilt_y;
    model.place(joints);
    return eye.see(model.poses()).value();
  };
  CHECK(senses(0, 0).norm() < 1e-12);
  const double a = 0.2, distance = 0.9 - 0.4 * std::cos(a), expected = 0.4 * std::sin(a) / distance;
  CHECK((senses(0, -a) - Vector2d(expected, 0)).norm() < 1e-12);
  CHECK((senses(a, 0) - Vector2d(0, expected)).norm() < 1e-12);
}

TEST_CASE("a learned map is unchanged by writing and reading, and is rejected for another robot") {
  Session session({.twitches = 0, .trials = 2}, session_with_twitches().learned(),
                  {{Vector2d(0.1, 0.1), Vector2d(0, 0), {}}});
  play(session, linear);
  const auto text = xml::write(file_of(session.learned(), session.goals()));
  const auto file = xml::parse<LearnedMapFile>(text, "learned");
  CHECK(learned_map_of(file, 2, 4).hebb() == session.learned().hebb());
  CHECK(goals_of(file, 2).front().alpha == session.goals().front().alpha);
  CHECK_THROWS_WITH(learned_map_of(file, 2, 5), Catch::Contains("other muscles"));
  CHECK_THROWS_WITH(learned_map_of(file, 4, 4), Catch::Contains("2 senses, not 4"));
}

TEST_CASE("goals of a grid are equally spaced, and a wrong number of senses is rejected") {
  const auto grid = xml::parse<Experiment>(
      "<sensorimotor view=\"v\"><grid columns=\"3\" rows=\"2\" half_width=\"0.3\" "
      "half_height=\"0.1\"/></sensorimotor>",
      "e");
  const auto goals = goals_of(grid, 2);
  REQUIRE(goals.size() == 6);
  CHECK(goals[1].target == Vector2d(0, -0.1));
  CHECK(goals[5].target == Vector2d(0.3, 0.1));
  CHECK_THROWS_WITH(goals_of(grid, 4), Catch::Contains("the cameras give 4"));
}
