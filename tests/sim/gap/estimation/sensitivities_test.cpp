#include "sim/gap/estimation/sensitivities.hpp"

#include "sim/gap/estimation/residual_vector.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace sim::estimation;
using sim::effects::Placed;

namespace {

Placed neutral(const char* type) { return {"flexor", *sim::effects::neutral(type)}; }

/// z as a linear function of an effect's sizes with these slopes.
ChangedBy linear(std::vector<double> slopes) {
  return [slopes](const Placed& placed) {
    sim::effects::AnyEffect effect = placed.effect;
    const auto parameters = sim::effects::parameters(effect);
    const auto sizes = sizes_of(placed);
    Eigen::VectorXd z = Eigen::VectorXd::Zero(4);
    for (std::size_t n = 0; n < sizes.size(); ++n)
      z[Eigen::Index(n)] = slopes[n] * *parameters[sizes[n]].value;
    return z;
  };
}

}  // namespace

TEST_CASE(
    "a cogging is evaluated with the given numbers of periods, or with its default without any") {
  const auto shapes = shaped(neutral("motor_cogging"), {7, 31});
  REQUIRE(shapes.size() == 2);
  CHECK(std::get<sim::effects::MotorCogging>(shapes[1].effect).periods_per_turn == 31);
  CHECK(sizes_of(shapes[0]).size() == 2);
  CHECK(shaped(neutral("motor_cogging"), {}).size() == 1);
}

TEST_CASE("a law with a speed is evaluated with seven scanned values and its default") {
  CHECK(shaped(neutral("gearbox_stribeck"), {}).size() == 8);
}

TEST_CASE("an effect without a shape parameter is evaluated once") {
  CHECK(shaped(neutral("tendon_stiffness"), {}).size() == 1);
}

TEST_CASE("the perturbation of a size changes z by a small part of its noise for any slope") {
  for (const double slope : {0.3, 30.0, 3000.0}) {
    const Placed shape = neutral("gearbox_coulomb");
    const auto sizes = sizes_of(shape);
    auto by = first_perturbations(shape, sizes);
    const Sensitivities all = sensitivities(shape, sizes, by, linear({slope}));
    const double rms = all.d.col(0).norm() / 2;
    CHECK(rms > 0.0007);
    CHECK(rms < 0.0121);
    CHECK(all.d(0, 0) == Approx(slope * all.perturbation[0]));
  }
}

TEST_CASE("a second size of the same kind is perturbed although the first does not change z") {
  const Placed shape = neutral("routing_capstan");  // around the path's bends, and around a post
  const auto sizes = sizes_of(shape);
  auto by = first_perturbations(shape, sizes);
  const auto initial = by[0];
  const Sensitivities all = sensitivities(shape, sizes, by, linear({0, 50}));
  CHECK(by[0] == initial);
  CHECK(all.d.col(0).norm() == 0);
  CHECK(all.d(1, 1) == Approx(50 * all.perturbation[1]));
  CHECK(all.d.col(1).norm() / 2 > 0.0007);
}

TEST_CASE("secants exist only for nonlinear laws with one size from 0 on") {
  const auto count = [](const char* type) {
    const Placed shape = neutral(type);
    return secants(shape, sizes_of(shape), linear({1, 1})).size();
  };
  CHECK(count("tendon_kite_line") == 2);
  CHECK(count("tendon_stiffness") == 0);  // both signs
  CHECK(count("skeleton_link_flexibility") == 0);
  CHECK(count("tendon_creep") == 0);  // shaped by its time constant, linear in its stiffness
}

TEST_CASE("a window that jumps is ignored in the change by a tiny step") {
  Eigen::VectorXd before = Eigen::VectorXd::Zero(1000), after = before;
  for (Eigen::Index k = 0; k < 1000; ++k)
    before[k] = std::sin(0.1 * double(k)), after[k] = before[k] + 1e-3 * std::cos(double(k));
  after[500] = before[500] + 47;
  const Eigen::VectorXd change = tiny_change(after, before);
  CHECK(change[500] == 0);
  CHECK(change[499] == Approx(1e-3 * std::cos(499.0)).margin(1e-12));
  CHECK(change.norm() / std::sqrt(1000) == Approx(1e-3 / std::sqrt(2)).epsilon(0.02));
}
