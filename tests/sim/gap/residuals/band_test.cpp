#include "sim/gap/residuals/band.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <random>

using namespace sim::residuals;

namespace {

constexpr int draws = 200000;

double beyond(double value, double band) { return std::max(0.0, std::abs(value) - band); }

/// Samples of a uniform value in a band plus noise N(0, 1).
std::vector<double> samples(double band) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> uniform(-band, band);
  std::normal_distribution<double> noise;
  std::vector<double> all;
  for (int k = 0; k < draws; ++k) all.push_back(uniform(random) + noise(random));
  return all;
}

}  // namespace

TEST_CASE("the formula of the noise beyond a band agrees with 200000 samples") {
  for (const double band : {0.01, 0.3, 1.0, 4.0}) {
    double square = 0;
    for (const double value : samples(band)) square += std::pow(beyond(value, band), 2);
    CHECK(noise_beyond(band) == Approx(square / draws).epsilon(0.03));
  }
  CHECK(noise_beyond(0) == 1);
  CHECK(noise_beyond(std::numeric_limits<double>::infinity()) == 0);
}

TEST_CASE("a wider band than the true one does not lower the normalized residual") {
  const auto mean_square = [](const std::vector<double>& values, double band) {
    double square = 0;
    for (const double value : values) {
      const Residual r{sim::effects::Stage::joint, "", "Nm",
                       {2 * beyond(value, band)},  0,  {2 * band}};
      square += std::pow(normalized(r, 0, 2), 2);
    }
    return square / draws;
  };
  const auto noise = samples(0.2);
  CHECK(mean_square(noise, 0.2) == Approx(1).epsilon(0.02));
  CHECK(mean_square(noise, 0.4) == Approx(1).epsilon(0.03));
  double without_hidden_noise = 0;
  for (const double value : noise) without_hidden_noise += std::pow(beyond(value, 0.4), 2) / draws;
  CHECK(without_hidden_noise < 0.7);
}

TEST_CASE("without a band the normalized residual is r/σ") {
  const Residual r{sim::effects::Stage::joint, "", "Nm", {-6, 0}, 0, {0, 1}};
  CHECK(normalized(r, 0, 2) == -3);
  CHECK(normalized(r, 1, 2) > 0);
}
