#include <catch2/catch.hpp>

#include "interfaces/robot/robot.hpp"
#include "sim/learning/sensorimotor/experiment.hpp"
#include "sim/learning/sensorimotor/eye.hpp"
#include "sim/learning/sensorimotor/learnt_file.hpp"
#include "sim/model/skeleton/skeleton_model.hpp"
#include "tests/sim/rigs.hpp"

using namespace sim::sensorimotor;
using Eigen::MatrixXd, Eigen::Vector2d, Eigen::Vector4d, Eigen::VectorXd;

namespace {

/// What is seen moves at once and in proportion: senses × muscles, a sense a newton.
const MatrixXd linear =
    (MatrixXd(2, 4) << 0.01, 0.01, -0.01, -0.01, -0.01, 0.01, 0.01, -0.01).finished();

/// A body without inertia, seen each 10 ms.
void play(Session& session, const MatrixXd& moves, double shift = 0) {
  for (double t = 0; !session.done(); t += 0.01) {
    const VectorXd seen = moves * session.motors_N(t) + Vector2d::Constant(shift);
    session.see(t, seen);
  }
}

Session twitched(std::uint64_t seed = 1) {
  SessionOptions options{.tries = 0, .seed = seed};
  Session session(options, Learnt(2, 4), {});
  play(session, linear);
  return session;
}

}  // namespace

TEST_CASE(
    "from twitches alone it is known which muscle moves what, and how much force that takes") {
  const Learnt learnt = twitched().learnt();
  const MatrixXd q = learnt.q();
  for (Eigen::Index s = 0; s < 2; ++s) {
    CHECK(q.row(s).norm() == Approx(1));
    for (Eigen::Index m = 0; m < 4; ++m)  // alike, however often each has twitched
      CHECK(q(s, m) == Approx(std::copysign(0.5, linear(s, m))).epsilon(0.01));
  }
  // With α = 1 all of a goal that synergies can reach is reached, were nothing cut off.
  const Vector2d k = learnt.force_per_sense_N();
  CHECK((linear.row(0) * q.row(0).transpose())(0) * k[0] == Approx(1).epsilon(1e-3));
  CHECK(learnt.motors_N(Vector2d(0, 0), Vector2d(0.1, 0.1)).norm() == 0);
  const VectorXd right = learnt.motors_N(Vector2d(1, 1), Vector2d(0.1, 0));
  CHECK(right[0] > 0);
  CHECK(right[2] == 0);  // it could only push
  CHECK(twitched(2).learnt().hebb() != learnt.hebb());
}

TEST_CASE("from try to try a goal is reached, the first try doing nothing") {
  SessionOptions options{.twitches = 0, .tries = 30};
  Session session(options, twitched().learnt(), {{Vector2d(0.2, -0.1), Vector2d(0, 0), {}}});
  play(session, linear, 0.05);
  const Goal& goal = session.goals().front();
  REQUIRE(goal.errors.size() == 30);
  CHECK(goal.errors.front() == Approx(std::hypot(0.15, 0.15)));
  CHECK(goal.errors.back() < 0.02 * goal.errors.front());
  CHECK(session.limited() == 0);
}

TEST_CASE("what asks for more than the most is held there and counted; unseen tries are repeated") {
  SessionOptions options{.twitches = 0, .tries = 30, .most_N = 5};
  Session weak(options, twitched().learnt(), {{Vector2d(0.5, 0), Vector2d(0, 0), {}}});
  double most_N = 0;
  for (double t = 0; !weak.done(); t += 0.01) {
    weak.see(t, linear * weak.motors_N(t));
    most_N = std::max(most_N, weak.motors_N(t).maxCoeff());
  }
  CHECK(most_N == Approx(5));
  CHECK(weak.limited() > 10);

  options.tries = 1;
  Session blind(options, twitched().learnt(), {{Vector2d(0.1, 0), Vector2d(0, 0), {}}});
  for (double t = 0; t < 10; t += 0.01) blind.motors_N(t);
  CHECK_FALSE(blind.done());
  CHECK(blind.blind() == 6);
  CHECK(blind.goals().front().errors.empty());
}

TEST_CASE("a camera that looks up from below sees the pendulum's end where it is") {
  const erp::Robot robot = erp::read_robot(rigs::config("pendulum/robot.xml"));
  const Eye eye(xml::read<sim::cameras::ViewConfig>(rigs::config("pendulum/view.xml")),
                sim::RobotTree(robot));
  REQUIRE(eye.senses() == 2);
  sim::SkeletonModel model(sim::RobotTree(robot), sim::Vec3::Zero());
  std::vector<sim::JointReading> joints;
  for (const erp::Joint& joint : robot.joints()) joints.push_back(sim::start_of(joint));
  const auto seen = [&](double tilt_x, double tilt_y) {
    joints[0].position[0] = tilt_x, joints[1].position[0] = tilt_y;
    model.place(joints);
    return eye.see(model.poses()).value();
  };
  CHECK(seen(0, 0).norm() < 1e-12);
  const double a = 0.2, far = 0.9 - 0.4 * std::cos(a), off = 0.4 * std::sin(a) / far;
  CHECK((seen(0, -a) - Vector2d(off, 0)).norm() < 1e-12);
  CHECK((seen(a, 0) - Vector2d(0, off)).norm() < 1e-12);
}

TEST_CASE("what was learnt reads back to the same bits, and not for another body") {
  Session session({.twitches = 0, .tries = 2}, twitched().learnt(),
                  {{Vector2d(0.1, 0.1), Vector2d(0, 0), {}}});
  play(session, linear);
  const auto text = xml::write(file_of(session.learnt(), session.goals()));
  const auto file = xml::parse<LearntFile>(text, "learnt");
  CHECK(learnt_of(file, 2, 4).hebb() == session.learnt().hebb());
  CHECK(goals_of(file, 2).front().alpha == session.goals().front().alpha);
  CHECK_THROWS_WITH(learnt_of(file, 2, 5), Catch::Contains("other muscles"));
  CHECK_THROWS_WITH(learnt_of(file, 4, 4), Catch::Contains("2 senses, not 4"));
}

TEST_CASE("goals of a grid are equally far apart, and goals have as many senses as there are") {
  const auto grid = xml::parse<Experiment>(
      "<sensorimotor view=\"v\"><grid columns=\"3\" rows=\"2\" half_width=\"0.3\" "
      "half_height=\"0.1\"/></sensorimotor>",
      "e");
  const auto goals = goals_of(grid, 2);
  REQUIRE(goals.size() == 6);
  CHECK(goals[1].target == Vector2d(0, -0.1));
  CHECK(goals[5].target == Vector2d(0.3, 0.1));
  CHECK_THROWS_WITH(goals_of(grid, 4), Catch::Contains("where there are 4"));
}
