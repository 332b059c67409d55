#include "sim/gap/diagnosis/answer.hpp"

#include <catch2/catch.hpp>

#include "sim/gap/diagnosis/identifiability.hpp"

using namespace sim::diagnosis;
namespace effects = sim::effects;

namespace {

/// An effect with these values of its fitted parameters, and intervals of ± half_width.
IdentifiedEffect with_values(const char* type, std::vector<double> values, double half_width) {
  IdentifiedEffect n = identified(effects::Placed{"flexor", *effects::neutral(type)});
  REQUIRE(n.values.size() == values.size());
  n.values = std::move(values);
  for (std::size_t k = 0; k < n.values.size(); ++k)
    n.intervals[k] = {n.values[k] - half_width, n.values[k] + half_width};
  return n;
}

}  // namespace

TEST_CASE(
    "an effect is undetermined if the intervals of all parameters contain their neutral values") {
  CHECK(undetermined(with_values("tendon_stiffness", {0.2}, 0.1)).empty());
  CHECK_THAT(undetermined(with_values("tendon_stiffness", {0.2}, 0.3)),
             Catch::Contains("neutral value"));
  CHECK(undetermined(with_values("motor_cogging", {0.002, 0}, 0.001))
            .empty());  // one of two parameters is neutral
  CHECK_THAT(undetermined(with_values("motor_cogging", {0.002, 0}, 0.003)),
             Catch::Contains("neutral value"));
}

TEST_CASE("alternatives with a size or a form parameter at a bound are removed") {
  std::vector<IdentifiedEffect> answer{with_values("gearbox_coulomb", {0.03}, 0.001)};
  IdentifiedEffect ageing = with_values("gearbox_ageing_stiction", {0.03, 1, 0.1}, 0.001);
  answer[0].alternatives = {ageing, ageing, ageing};
  answer[0].alternatives[0].values[1] = ageing.bounds[1].low;  // stiction without delay
  answer[0].alternatives[2].values[0] = ageing.bounds[0].high;
  remove_alternatives_at_bounds(answer);
  REQUIRE(answer[0].alternatives.size() == 1);
  CHECK(answer[0].alternatives[0].values == ageing.values);
}

TEST_CASE("an effect with a value at a bound is undetermined") {
  IdentifiedEffect n = with_values("tendon_kite_line", {1e-4}, 1e-5);
  CHECK(undetermined(n).empty());
  n.values[0] = n.bounds[0].high;
  CHECK_THAT(undetermined(n), Catch::Contains("at its bound"));
  n.values[0] = 0, n.intervals[0] = {0, 1e-6};  // the lower bound is the neutral value
  CHECK_THAT(undetermined(n), Catch::Contains("neutral value"));
}
