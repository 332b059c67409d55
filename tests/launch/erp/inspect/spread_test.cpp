#include "launch/erp/inspect/spread.hpp"

#include <catch2/catch.hpp>

TEST_CASE("a quantile is a value that was measured, whatever the order they came in") {
  launch::Spread spread;
  for (const double value : {5.0, 1.0, 3.0, 2.0, 4.0}) spread.add(value);
  CHECK(spread.quantile(0) == 1.0);
  CHECK(spread.quantile(0.5) == 3.0);
  CHECK(spread.quantile(0.8) == 4.0);
  CHECK(spread.quantile(0.99) == 5.0);
  spread.add(0.0);
  CHECK(spread.quantile(0) == 0.0);
  CHECK(spread.count() == 6);
}

TEST_CASE("the spread of nothing is zero") {
  launch::Spread spread;
  CHECK(spread.quantile(0.5) == 0.0);
}
