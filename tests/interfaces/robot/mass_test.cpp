#include <catch2/catch.hpp>
#include <cmath>

#include "interfaces/robot/mass.hpp"

using erp::Body, erp::Capsule, erp::Box, erp::Sphere, erp::Weight, erp::Mass;

namespace {

bool is_inside(const Sphere& s, const xml::Vec3& p) {
  return std::hypot(p[0] - s.at_m[0], p[1] - s.at_m[1], p[2] - s.at_m[2]) < s.radius_m;
}
bool is_inside(const Box& b, const xml::Vec3& p) {
  for (std::size_t i = 0; i < 3; ++i)
    if (std::abs(p[i] - b.at_m[i]) > b.size_m[i] / 2) return false;
  return true;
}
bool is_inside(const Capsule& c, const xml::Vec3& p) {
  xml::Vec3 segment, offset;
  double dot = 0, length2 = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    segment[i] = c.to_m[i] - c.from_m[i], offset[i] = p[i] - c.from_m[i];
    dot += segment[i] * offset[i], length2 += segment[i] * segment[i];
  }
  const double t = std::min(1.0, std::max(0.0, dot / length2));
  return std::hypot(offset[0] - t * segment[0], offset[1] - t * segment[1],
                    offset[2] - t * segment[2]) < c.radius_m;
}

/// Mass of a solid within ±0.2 m, approximated by point masses on a grid with a spacing of 2.5 mm.
template <class Solid>
Mass mass_of_grid(const Solid& solid, double density) {
  const double edge = 0.0025;
  Mass sum;
  std::vector<xml::Vec3> points;
  for (double x = -0.2 + edge / 2; x < 0.2; x += edge)
    for (double y = -0.2 + edge / 2; y < 0.2; y += edge)
      for (double z = -0.2 + edge / 2; z < 0.2; z += edge)
        if (is_inside(solid, {x, y, z})) points.push_back({x, y, z});
  const double m = density * edge * edge * edge;
  for (const auto& p : points) {
    sum.mass_kg += m;
    for (std::size_t i = 0; i < 3; ++i) sum.com_m[i] += p[i] / static_cast<double>(points.size());
  }
  for (const auto& p : points) {
    const double x = p[0] - sum.com_m[0], y = p[1] - sum.com_m[1], z = p[2] - sum.com_m[2];
    const std::array<double, 6> inertia{y * y + z * z, x * x + z * z, x * x + y * y,
                                        -x * y,        -x * z,        -y * z};
    for (std::size_t k = 0; k < 6; ++k) sum.inertia_kg_m2[k] += m * inertia[k];
  }
  return sum;
}

template <class Solid>
void check_against_point_masses(const Solid& solid) {
  Body body;
  body.density_kg_per_m3 = 1130;
  body.parts = {solid};
  const Mass exact = mass_of(body), approximate = mass_of_grid(solid, 1130);
  CHECK(exact.mass_kg == Approx(approximate.mass_kg).epsilon(0.01));
  const double scale =
      approximate.inertia_kg_m2[0] + approximate.inertia_kg_m2[1] + approximate.inertia_kg_m2[2];
  for (std::size_t i = 0; i < 3; ++i) CHECK(std::abs(exact.com_m[i] - approximate.com_m[i]) < 1e-4);
  for (std::size_t k = 0; k < 6; ++k)
    CHECK(std::abs(exact.inertia_kg_m2[k] - approximate.inertia_kg_m2[k]) < 0.01 * scale);
}

}  // namespace

TEST_CASE("mass and inertia of a solid equal those of its point masses within 1 %") {
  check_against_point_masses(Sphere{{}, {0.02, 0.03, -0.05}, 0.08});
  check_against_point_masses(Box{{}, {0.02, 0.03, -0.05}, {0.1, 0.2, 0.05}});
  check_against_point_masses(Capsule{{}, {-0.08, -0.05, 0.02}, {0.09, 0.03, 0.1}, 0.06});
}

TEST_CASE("weights are summed about their common centre of mass") {
  Body body;
  body.parts = {Weight{{}, {0.1, 0, 0}, 1}, Weight{{}, {-0.1, 0, 0}, 1},
                Weight{{}, {0, 0, 0.3}, 2}};
  const Mass mass = mass_of(body);
  CHECK(mass.mass_kg == 4);
  CHECK(mass.com_m == xml::Vec3{0, 0, 0.15});
  CHECK(mass.inertia_kg_m2[0] == Approx(4 * 0.15 * 0.15));
  CHECK(mass.inertia_kg_m2[1] == Approx(4 * 0.15 * 0.15 + 2 * 0.01));
  CHECK(mass.inertia_kg_m2[2] == Approx(0.02));
  CHECK(std::abs(mass.inertia_kg_m2[4]) < 1e-12);
}

TEST_CASE("a body with given mass keeps mass, centre of mass and inertia") {
  Body body;
  body.mass_kg = 2, body.com_m = {1, 2, 3}, body.inertia_kg_m2 = {0.1, 0.2, 0.25};
  body.products_kg_m2 = {0.01, 0.02, 0.03};
  body.parts = {Sphere{{}, {0, 0, 0}, 0.1}};  // without a density, it is only a shape
  const Mass mass = mass_of(body);
  CHECK(mass.mass_kg == 2);
  CHECK(mass.com_m == body.com_m);
  CHECK(mass.inertia_kg_m2 == std::array<double, 6>{0.1, 0.2, 0.25, 0.01, 0.02, 0.03});
}
