#include <catch2/catch.hpp>
#include <filesystem>
#include <fstream>
#include <random>

#include "sim/learning/experience/base_file.hpp"
#include "sim/learning/experience/drives.hpp"
#include "sim/learning/experience/motors.hpp"
#include "tests/sim/rigs.hpp"

using namespace sim::experience;
using Eigen::MatrixXd, Eigen::Vector3d, Eigen::VectorXd;

namespace {

const std::vector<Burst> bursts{{.of = Role::agonist, .for_s = 1.2},
                                {.of = Role::agonist, .at_s = 1.2, .for_s = 1, .share = 0.3},
                                {.of = Role::antagonist, .for_s = 1.5},
                                {.of = Role::antagonist, .at_s = 0.9, .for_s = 0.7, .share = -0.4}};

/// A nonlinear hand with four drives: position in m from scales in V s.
Vector3d hand_of(const VectorXd& s) {
  const double a = 0.1 * s[0], b = 0.5 + 0.1 * s[1] + 0.05 * s[3], c = 0.9 + 0.1 * s[2];
  return {0.3 * std::sin(b) + 0.2 * std::sin(b + c), a * 0.3,
          -0.3 * std::cos(b) - 0.2 * std::cos(b + c)};
}

VectorXd drawn(std::mt19937& random, double spread) {
  std::normal_distribution<double> normal(0, spread);
  return VectorXd::NullaryExpr(4, [&] { return normal(random); });
}

/// Experiences near the smallest scales for each place, as a training collects them.
Base base_of_samples(int count, double spread) {
  std::mt19937 random(3);
  Base base(4, {});
  for (int k = 0; k < count; ++k) {
    VectorXd s = drawn(random, spread);
    s[3] = 0.5 * s[1] + 0.2 * drawn(random, 1)[3];
    base.add({0, s, hand_of(s)});
  }
  return base;
}

/// Two muscles with one drive.
BaseFile two_muscles() {
  BaseFile file;
  file.bursts.all = bursts, file.pattern_V = 6;
  file.drives.all = {{.name = "elbow", .shares = {1, -0.5}}};
  file.starts.all = {{{}, {0.01, -0.02}}};
  return file;
}

}  // namespace

TEST_CASE("agonists are wound up by their scale, antagonists paid out, until the pattern ends") {
  const Patterns patterns(bursts);
  CHECK(patterns.end_s() == Approx(2.2));
  const MatrixXd drives = (MatrixXd(2, 1) << 1, -0.5).finished();
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  bool has_braked = false;
  for (double t = 0.0005; t < 3; t += 0.001) {
    const VectorXd v = voltages_V(patterns, drives, VectorXd::Constant(1, 2), t);
    sum += 0.001 * v, has_braked |= v[1] > 0;
  }
  CHECK(sum[0] == Approx(2).epsilon(1e-4));
  CHECK(sum[1] == Approx(-1).epsilon(1e-4));
  CHECK(has_braked);  // by the burst with a negative share
  CHECK(voltages_V(patterns, drives, VectorXd::Constant(1, 2), 2.3).norm() == 0);
  CHECK_THROWS_WITH(Patterns({bursts[0]}), Catch::Contains("antagonists"));
  CHECK_THROWS_WITH(matrix_of({{.name = "elbow", .shares = {1}}}, 2),
                    Catch::Contains("\"elbow\" has 1 shares; the robot has 2 muscles"));
}

TEST_CASE("for a linear hand the fitted influence and inverse model are correct") {
  const MatrixXd h = MatrixXd::Random(3, 4);
  std::mt19937 random(1);
  Base base(4, {});
  CHECK(base.inverse(0, {1, 2, 3}).norm() == 0);
  for (int k = 0; k < 60; ++k) {
    const VectorXd s = drawn(random, 1);
    base.add({0, s, Vector3d(0.1, 0.2, 0.3) + h * s});
  }
  CHECK((base.influence(0, {0, 0, 0}) - h).norm() < 0.05);
  const Vector3d target(0.5, -0.3, 0.4);
  CHECK((Vector3d(0.1, 0.2, 0.3) + h * base.inverse(0, target) - target).norm() < 0.01);
  CHECK(base.count(1) == 0);
  CHECK(base.inverse(1, target).norm() == 0);  // no experience of that start
}

TEST_CASE("1500 experiences give less than half the error of 20 at new targets") {
  std::mt19937 random(9);
  double error_of_20 = 0, error_of_1500 = 0;
  const Base small = base_of_samples(20, 1.5), large = base_of_samples(1500, 1.5);
  for (int k = 0; k < 50; ++k) {
    VectorXd s = drawn(random, 0.8);
    s[3] = 0.5 * s[1];
    const Vector3d target = hand_of(s);
    error_of_20 += (hand_of(small.inverse(0, target)) - target).norm() / 50;
    error_of_1500 += (hand_of(large.inverse(0, target)) - target).norm() / 50;
  }
  CHECK(error_of_1500 < 0.001);
  CHECK(error_of_1500 < 0.5 * error_of_20);
}

TEST_CASE("the weighted inverse inverts the influence and uses only free drives") {
  const MatrixXd h = MatrixXd::Random(3, 5);
  const VectorXd free = (VectorXd(5) << 1, 1, 1, 1, 1e-9).finished();
  const MatrixXd k = weighted_inverse(h, free);
  CHECK((h * k - MatrixXd::Identity(3, 3)).norm() < 1e-3);
  CHECK(k.row(4).norm() < 1e-6);
  CHECK(weighted_inverse(MatrixXd::Zero(3, 5), free).allFinite());
}

TEST_CASE(
    "linear and fuzzy feedback move the hand to the target, and an invalid rules file is "
    "rejected") {
  const Base base = base_of_samples(400, 1);
  const std::string rules = rigs::config("seven_dof/feedback.fll");
  const auto linear = linear_feedback(base, 0, hand_of(VectorXd::Zero(4)), 2);
  const auto fuzzy = fuzzy_feedback(base, 0, rules);
  for (const Feedback* feedback : {linear.get(), fuzzy.get()}) {
    const VectorXd v = feedback->drives_V({0.004, 0, 0}, {0, 0, 0});
    const Vector3d motion = base.influence(0, hand_of(VectorXd::Zero(4))) * v;
    CHECK(motion.x() > 0);
    CHECK(motion.normalized().x() > 0.9);
    CHECK((v + feedback->drives_V({-0.004, 0, 0}, {0, 0, 0})).norm() < 1e-9);
    CHECK(feedback->drives_V({0, 0, 0}, {0, 0, 0}).norm() < 1e-12);
  }
  CHECK(fuzzy->drives_V({0.01, 0, 0}, {-0.1, 0, 0}).norm() <
        0.2 * fuzzy->drives_V({0.01, 0, 0}, {0, 0, 0})
                  .norm());  // less voltage while the hand approaches
  CHECK_THROWS_WITH(fuzzy_feedback(base, 0, "none.fll"), Catch::Contains("none.fll"));
  const auto invalid_file = std::filesystem::temp_directory_path() / "erp_wrong.fll";
  std::ofstream(invalid_file) << "Engine: feedback\nInputVariable: elsewhere\n  range: 0 1\n";
  CHECK_THROWS_WITH(fuzzy_feedback(base, 0, invalid_file.string()), Catch::Contains("off_m"));
  std::filesystem::remove(invalid_file);
}

TEST_CASE("a reach moves to its start, plays its pattern, and corrects only with a known hand") {
  const BaseFile file = two_muscles();
  const MatrixXd gain = (MatrixXd(1, 3) << 30, 0, 0).finished();
  struct Gain : Feedback {
    explicit Gain(MatrixXd gain) : matrix(std::move(gain)) {}
    VectorXd drives_V(const Vector3d& off, const Vector3d&) const override { return matrix * off; }
    MatrixXd matrix;
  };
  const bool is_unknown = GENERATE(false, true);
  Reach reach =
      reach_with(file, 0, {0.1, 0, 0}, VectorXd::Constant(1, 1.5), std::make_shared<Gain>(gain));
  VectorXd line = Eigen::Vector2d(0, 0);
  double wound_Vs = 0;
  for (double t = 5; t < 16; t += 0.002) {
    const Vector3d hand(0.06 * wound_Vs, 0, 0);  // the pattern alone reaches 0.09
    const auto measured = is_unknown ? std::nullopt : std::optional<Vector3d>(hand);
    const MuscleCommand command = reach.step(t, line, measured);
    if (command.lengths) line = command.by_muscle;
    else wound_Vs += 0.002 * command.by_muscle[0];
    if (t < 6.999) CHECK(command.lengths);
  }
  CHECK((line - Eigen::Vector2d(0.01, -0.02)).norm() < 1e-9);
  CHECK(reach.done());
  CHECK(reach.settled_m().has_value() == !is_unknown);
  CHECK(wound_Vs == Approx(is_unknown ? 1.5 : 0.1 / 0.06).epsilon(0.002));
  if (is_unknown) return;
  CHECK(reach.began_m()->x() == Approx(0).margin(1e-6));
  CHECK(reach.settled_m()->x() == Approx(0.09).epsilon(0.001));
  CHECK(reach.corrected_m()->x() == Approx(0.1).epsilon(0.001));
  CHECK(!reach.limited());
}

TEST_CASE("a pattern is scaled down to the limit of its voltage") {
  const BaseFile file = two_muscles();
  const VectorXd small_scale = VectorXd::Constant(1, 1), large_scale = VectorXd::Constant(1, 10);
  CHECK(peak_V(file, large_scale) == Approx(10 * peak_V(file, small_scale)));
  CHECK(within_voltage(file, small_scale) == small_scale);
  CHECK(peak_V(file, within_voltage(file, large_scale)) == Approx(file.pattern_V));
}

TEST_CASE(
    "a base is unchanged by writing and reading, and a base that does not fit the robot is "
    "rejected") {
  BaseFile file = two_muscles();
  file.hand.body = "hand";
  file.experiences.all = {{{}, 0, {1.25}, {0.1, 0.2, 0.3}}};
  const auto read_file = xml::parse<BaseFile>(xml::write(file), "base.xml");
  CHECK_NOTHROW(check(read_file, 2));
  CHECK(base_of(read_file).all().front().scales_Vs[0] == 1.25);
  CHECK(rows_of(base_of(read_file)).front().end_m == file.experiences.all.front().end_m);
  CHECK_THROWS_WITH(check(read_file, 3), Catch::Contains("2 shares; the robot has 3 muscles"));
  BaseFile invalid_file = read_file;
  invalid_file.experiences.all.front().start = 1;
  CHECK_THROWS_WITH(check(invalid_file, 2), Catch::Contains("start 1, but there are 1"));
  invalid_file = read_file, invalid_file.experiences.all.front().scales_Vs = {1, 2};
  CHECK_THROWS_WITH(check(invalid_file, 2), Catch::Contains("2 numbers, but there are 1 drives"));
  invalid_file = read_file, invalid_file.starts.all.clear();
  CHECK_THROWS_WITH(check(invalid_file, 2), Catch::Contains("<start>"));
}

TEST_CASE("there is one drive per degree of freedom, and voltage 0 holds a shaft under tension") {
  const erp::Robot robot = erp::read_robot(rigs::config("seven_dof/robot.xml"));
  const auto drives = drives_of(robot);
  REQUIRE(drives.size() == 7);
  CHECK(drives[3].name == "elbow");
  for (std::size_t d = 0; d < 7; ++d) {
    CHECK(drives[d].shares[2 * d] == Approx(1).epsilon(1e-6));
    CHECK(drives[d].shares[2 * d + 1] == Approx(-1).epsilon(1e-6));
  }
  const auto arm = drives_of(erp::read_robot(rigs::config("arm/robot.xml")));
  REQUIRE(arm.size() == 4);
  CHECK(arm[0].name == "shoulder.x");
  const Motors motors(robot);
  const EcuReference command = motors.ecu_reference(0, {false, VectorXd::Zero(14)}, 100);
  CHECK(command.mode == erp::Mode::voltage);
  CHECK(command.reference > 0.1);
  CHECK(command.reference < 0.35);
  CHECK(motors.ecu_reference(0, {true, VectorXd::Constant(14, -0.01)}, 100).reference == -0.01);
}
