#include <catch2/catch.hpp>

#include "sim/learning/synergy/bank_file.hpp"
#include "sim/learning/training_loop/random_stream.hpp"
#include "tests/sim/rigs.hpp"

using namespace sim::synergy;
using Eigen::MatrixXd, Eigen::Vector3d, Eigen::VectorXd;

namespace {

/// Five muscles; the hand is at `reach · w`.
const MatrixXd reach =
    (MatrixXd(3, 5) << 1, 0, 0, 0.5, 0, 0, 1, 0, 0, 0.5, 0, 0, 1, 0.2, 0.2).finished();

MotorPlan plan_of(const VectorXd& weights, double value = 1) {
  return {weights, {}, reach * weights, value};
}

/// Plans that all lie to one side of the origin.
Bank bank(int count) {
  auto random = sim::training_loop::random_stream(5);
  std::uniform_real_distribution<double> coordinate(0, 0.1);
  std::vector<MotorPlan> plans;
  for (int k = 0; k < count; ++k)
    plans.push_back(plan_of(VectorXd::NullaryExpr(5, [&] { return coordinate(random); })));
  return {{}, plans};
}

HandPath straight_path(const Vector3d& displacement_m, double time_s, double wait_s) {
  HandPath path;
  for (double t = 0; t <= time_s + wait_s; t += path.sample_s)
    path.at_m.push_back(sim::minimum_jerk(t / time_s).fraction * displacement_m);
  return path;
}

}  // namespace

TEST_CASE("a blend reaches its target although all near plans lie on one side of it") {
  const Bank stored = bank(60);
  for (const Vector3d& target : {Vector3d(0.08, 0.07, 0.09), Vector3d(0.03, 0.03, 0.03)}) {
    const Blend blend = stored.blend(target);
    CHECK((reach * blend.plan.weights_m - target).norm() < 0.008);
    double sum = 0;
    for (const double credit : blend.credits) sum += credit;
    CHECK(sum == Approx(1));
  }
  CHECK(stored.blend({9, 9, 9}).plan.weights_m.allFinite());
  CHECK_THROWS_WITH(Bank().blend({0, 0, 0}), Catch::Contains("without plans"));
}

TEST_CASE("a blend extrapolates at most max_extrapolation_m beyond its plans") {
  const std::vector<MotorPlan> plans{plan_of(VectorXd::Unit(5, 0) * 0.1),
                                     plan_of(VectorXd::Unit(5, 0) * 0.2)};
  const double target_m = 0.4;
  const auto x_m = [&](double max_extrapolation_m) {
    const Bank two({.max_extrapolation_m = max_extrapolation_m}, plans);
    return (reach * two.blend({target_m, 0, 0}).plan.weights_m).x();
  };
  const double mean_m = x_m(0), unlimited_m = x_m(9);
  CHECK(unlimited_m > mean_m + 0.03);
  CHECK(x_m(0.05) - mean_m == Approx(0.05 / (target_m - mean_m) * (unlimited_m - mean_m)));
  CHECK(x_m(0.3) == unlimited_m);  // within max_extrapolation_m
}

TEST_CASE("rewards are credited to contributors, and plans of larger value contribute more") {
  Bank two({.rate = 0.5},
           {plan_of(VectorXd::Constant(5, 0.1)), plan_of(VectorXd::Constant(5, 0.2))});
  const Vector3d between = reach * VectorXd::Constant(5, 0.15);
  CHECK(two.blend(between).credits[0] == Approx(0.5));
  two.credit({1, 0}, 0);
  CHECK(two.plans()[0].value == Approx(0.5));
  CHECK(two.plans()[1].value == 1);
  CHECK(two.blend(between).credits[0] == Approx(0.2));
  two.credit({1, 1}, 1.5), two.credit({1, 0}, -1000);  // values of zero
  CHECK(two.blend(between).plan.weights_m.allFinite());
}

TEST_CASE("a full bank removes the less valuable of two plans for the same place") {
  std::vector<MotorPlan> plans{plan_of(VectorXd::Constant(5, 0.1), 1.2),
                               plan_of(VectorXd::Constant(5, 0.101), 0.9),
                               plan_of(VectorXd::Constant(5, 0.3), 0.1)};
  Bank stored({.capacity = 2}, plans);
  stored.trim();
  REQUIRE(stored.plans().size() == 2);
  CHECK(stored.plans()[0].value == 1.2);
  CHECK(stored.plans()[1].value == 0.1);  // the only plan for its place
  stored.cut(0);
  CHECK(stored.plans().size() == 1);
  CHECK(components(bank(60), 1.0) == 5);
  CHECK(components(Bank({}, {plans[0], plans[2]}), 0.99) == 1);
}

TEST_CASE("a varied plan is near the plan and within bounds") {
  auto random = sim::training_loop::random_stream(1);
  const MotorPlan plan = plan_of(VectorXd::Constant(5, 0.05));
  const MotorPlan varied_plan = varied(plan, {}, random);
  CHECK(varied_plan.weights_m != plan.weights_m);
  CHECK((varied_plan.weights_m - plan.weights_m).cwiseAbs().maxCoeff() < 0.03);
  const MotorPlan bounded =
      varied(plan, {.weights = 0, .weights_m = 0, .rise = 50, .overshoot = 50}, random);
  CHECK(bounded.weights_m == plan.weights_m);
  CHECK((bounded.signal.rise_s == 0.3 || bounded.signal.rise_s == 1.6));
  CHECK(std::abs(bounded.signal.overshoot) == 0.4);
}

TEST_CASE("on the return wound-up lines are paid out first, then the others are wound up") {
  const ReturnPath return_path({.watch_s = 1, .return_s = 2, .hold_s = 0.5}, 3,
                               Eigen::Vector2d(-0.02, 0.01));
  CHECK(return_path.at(3) == Eigen::Vector2d(-0.02, 0.01));
  CHECK((return_path.at(3.5) - Eigen::Vector2d(-0.01, 0.01)).norm() < 1e-12);
  CHECK((return_path.at(4) - Eigen::Vector2d(0, 0.01)).norm() < 1e-12);
  CHECK((return_path.at(4.5) - Eigen::Vector2d(0, 0.005)).norm() < 1e-12);
  CHECK(return_path.at(5).norm() == 0);
  CHECK(!return_path.done(5.4));
  CHECK(return_path.done(5.6));
}

TEST_CASE("a trial plays its signal with proportional noise, then returns the lines") {
  const MotorPlan plan{VectorXd::Constant(2, 0.04), {.rise_s = 0.8, .overshoot = 0.25}, {0, 0, 0}};
  const TrialTimes times{.watch_s = 1, .return_s = 1, .hold_s = 0.5};
  Trial quiet(plan, times, 0, 1), noisy(plan, times, 0.1, 1);
  double largest_m = 0, squares = 0, end = 0;
  int count = 0;
  for (double t = 3; !quiet.done(); t += 0.002) {
    end = t;
    const VectorXd line = quiet.step(t), noisy_line = noisy.step(t);
    quiet.see(t, Vector3d(t, 0, 0));
    if (t == 3) CHECK(line.norm() + noisy_line.norm() == 0);  // no signal, no noise
    largest_m = std::max(largest_m, -line[0]);
    if (t > 4.5 && t < 5.2) {
      CHECK(line[0] == Approx(-0.04));
      squares += (noisy_line - line).squaredNorm() / 2, ++count;
    }
    if (t > 5.71) CHECK(line.norm() + noisy_line.norm() < 1e-12);
  }
  CHECK(largest_m == Approx(0.05).epsilon(0.01));
  CHECK(std::sqrt(squares / count) == Approx(0.1 * 0.04).epsilon(0.5));
  CHECK(quiet.end_s() == Approx(1.2));
  CHECK(quiet.path().at_m.front().x() == Approx(3).margin(0.003));
  CHECK(quiet.path().at_m.size() == Approx(220).margin(2));  // without the return
  CHECK(end == Approx(3 + 2.2 + 1.5).margin(0.01));
  CHECK(quiet.last_m().x() == Approx(end));
}

TEST_CASE("an overlap is a strike, and time in the zone adds to the reward") {
  const BottleConfig bottle;  // touched at 0.0725 m
  const HandPath path = straight_path({0.3, 0, 0}, 1, 1);
  const Outcome reached = evaluate(bottle, {0.3, 0, 0}, path, 1);
  CHECK(reached.struck);
  CHECK(reached.strike_s == Approx(0.66).margin(0.03));
  CHECK(reached.strike_speed_m_per_s == Approx(0.47).margin(0.05));
  CHECK(reached.stayed == 1);
  CHECK(reached.reward == Approx(1.5));
  const Outcome passed = evaluate(bottle, {0.15, 0, 0}, path, 1);
  CHECK(passed.struck);
  CHECK(passed.reward == Approx(1));  // it did not stay
  const Outcome missed = evaluate(bottle, {0.3, 0.1, 0}, path, 1);
  CHECK(!missed.struck);
  CHECK(missed.nearest_m == Approx(0.0275).margin(1e-6));
  CHECK(missed.reward == Approx(0.5));
  CHECK(evaluate(bottle, {0.3, 0, 0.13}, path, 1).struck);  // at its lower end
  CHECK(!evaluate(bottle, {0.3, 0, 0.15}, path, 1).struck);
  CHECK(!evaluate(bottle, {0, 0, 0}, {}, 1).struck);
}

TEST_CASE(
    "the minimum-jerk path has a relative jerk of 1, and an oscillating path has more than 5") {
  const HandPath smooth = straight_path({0.2, 0.1, -0.3}, 2, 0);
  CHECK(relative_jerk(smooth, 2) == Approx(1).epsilon(0.25));
  HandPath oscillating = smooth;
  for (std::size_t k = 0; k < oscillating.at_m.size(); ++k)
    oscillating.at_m[k].y() += 0.02 * std::sin(0.1 * double(k));
  CHECK(relative_jerk(oscillating, 2) > 5);
  CHECK((rest_of(straight_path({1, 2, 3}, 1, 0.5)) - Vector3d(1, 2, 3)).norm() < 1e-9);
}

namespace {

/// A trial in which the hand moves by 0.3 m, and then back by the fraction `back` of it.
Trial trial_returning(double back) {
  const MotorPlan plan{VectorXd::Constant(2, 0.04), {.rise_s = 0.8, .overshoot = 0}, {0, 0, 0}};
  Trial trial(plan, {.watch_s = 1, .return_s = 1, .hold_s = 0.5}, 0, 1);
  for (double t = 0; !trial.done(); t += 0.002) {
    trial.step(t);
    const double reached =
        sim::minimum_jerk(t / 0.8).fraction - back * sim::minimum_jerk(t - 2.2).fraction;
    trial.see(t, Vector3d(0.3 * reached, 0, 0));
  }
  return trial;
}

}  // namespace

TEST_CASE(
    "a plan is stored at the place it reached, with a value that decreases with the distance to "
    "its target") {
  const BottleConfig bottle;
  const TrialResult reached = result_of(trial_returning(1), bottle, {0, 0, 0}, {0.3, 0, 0});
  REQUIRE(reached.plan);
  CHECK((reached.plan->at_m - Vector3d(0.3, 0, 0)).norm() < 1e-9);
  CHECK(reached.plan->weights_m == VectorXd::Constant(2, 0.04));
  CHECK(reached.plan->value == Approx(1.5));
  CHECK(reached.credit == Approx(1.5));
  const TrialResult missed = result_of(trial_returning(1), bottle, {0, 0, 0}, {0.3, 0.06, 0});
  REQUIRE(missed.plan);
  CHECK(missed.plan->at_m == reached.plan->at_m);
  CHECK(missed.plan->value == Approx(1.5 * std::exp(-0.5)));
}

TEST_CASE("a plan from which the hand does not return is not stored even if it struck") {
  const TrialResult not_returned =
      result_of(trial_returning(0.9), {}, {0, 0, 0}, {0.3, 0, 0});  // 30 mm off
  CHECK(not_returned.outcome.struck);
  CHECK(not_returned.off_m == Approx(0.03));
  CHECK(!not_returned.returned);
  CHECK(not_returned.credit == 0);
  CHECK(!not_returned.plan);
  const TrialResult nearly_returned = result_of(trial_returning(0.95), {}, {0, 0, 0}, {0.3, 0, 0});
  CHECK(nearly_returned.returned);
  CHECK(nearly_returned.plan);
}

TEST_CASE("a bank is unchanged by writing and reading, and a bank that does not fit is rejected") {
  BankFile file;
  file.hand.body = "hand";
  file.muscles.all = {{{}, "right_biceps"}};
  file.plans.all = {{{}, {0.1, 0.2, 0.3}, 1.25, 0.7, 0.1, {0.02}}};
  const auto read_file = xml::parse<BankFile>(xml::write(file), "bank.xml");
  CHECK_NOTHROW(check(read_file));
  CHECK(rows_of(bank_of(read_file)).front().value == 1.25);
  CHECK(bank_of(read_file).plans().front().signal.overshoot == 0.1);
  BankFile invalid = read_file;
  invalid.plans.all.front().weights_m = {1, 2};
  CHECK_THROWS_WITH(check(invalid),
                    Catch::Contains("2 weights, but there are 1 <learned> muscles"));
  invalid.plans.all.clear();
  CHECK_THROWS_WITH(check(invalid), Catch::Contains("<plan>"));
  CHECK_THROWS_WITH(actuators_of({{{}, "no_such"}}, erp::read_robot(rigs::config("arm/robot.xml"))),
                    Catch::Contains("no_such"));
}
