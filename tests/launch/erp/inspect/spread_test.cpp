#include "launch/erp/inspect/spread.hpp"

#include <catch2/catch.hpp>

TEST_CASE("a quantile is one of the added values, independent of their order") {
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

TEST_CASE("a quantile without values is 0") {
  launch::Spread spread;
  CHECK(spread.quantile(0.5) == 0.0);
}
