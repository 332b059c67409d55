#include "interfaces/robot/mass.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace erp {
namespace {

using std::numbers::pi;

double square(double x) { return x * x; }

Mass mass_of_part(const Sphere& s, double density) {
  const double m = density * 4 / 3 * pi * s.radius_m * square(s.radius_m);
  const double i = 0.4 * m * square(s.radius_m);
  return {m, s.at_m, {i, i, i, 0, 0, 0}};
}

Mass mass_of_part(const Box& b, double density) {
  const double m = density * b.size_m[0] * b.size_m[1] * b.size_m[2];
  const double x = square(b.size_m[0]), y = square(b.size_m[1]), z = square(b.size_m[2]);
  return {m, b.at_m, {m / 12 * (y + z), m / 12 * (x + z), m / 12 * (x + y), 0, 0, 0}};
}

/// A cylinder (length l, mass m_c) and two half spheres (total mass m_s). The centre of mass of a
/// half sphere lies 3/8 r beyond the end of the cylinder. Moments of inertia about the centre:
///   axial       m_c r²/2 + m_s 2r²/5
///   transverse  m_c (l²/12 + r²/4) + m_s (2r²/5 + l²/4 + 3 l r/8)
Mass mass_of_part(const Capsule& c, double density) {
  const Vec3 &a = c.from_m, &b = c.to_m;
  const double l = std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]), r = c.radius_m;
  const double cylinder = density * pi * r * r * l, spheres = density * 4 / 3 * pi * r * r * r;
  const double axial = cylinder * r * r / 2 + spheres * 0.4 * r * r;
  const double transverse =
      cylinder * (l * l / 12 + r * r / 4) + spheres * (0.4 * r * r + l * l / 4 + 3 * l * r / 8);
  Mass mass{cylinder + spheres, {}, {}};
  Vec3 axis{0, 0, 1};
  for (std::size_t i = 0; i < 3; ++i) {
    mass.com_m[i] = (a[i] + b[i]) / 2;
    if (l > 0) axis[i] = (b[i] - a[i]) / l;
  }
  // I = transverse E + (axial − transverse) axis axisᵀ, E the unit matrix
  constexpr std::size_t entries[6][2]{{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}};
  for (std::size_t k = 0; k < 6; ++k)
    mass.inertia_kg_m2[k] = (k < 3 ? transverse : 0.0) +
                            (axial - transverse) * axis[entries[k][0]] * axis[entries[k][1]];
  return mass;
}

Mass mass_of_part(const Weight& w, double) { return {w.mass_kg, w.at_m, {}}; }

/// Steiner: changes the inertia about the centre of mass to that about a point at distance `d`;
/// with `sign` −1 in the other direction.
void shift(Mass& mass, const Vec3& d, double sign) {
  const double m = sign * mass.mass_kg;
  auto& i = mass.inertia_kg_m2;
  i[0] += m * (square(d[1]) + square(d[2])), i[3] -= m * d[0] * d[1];
  i[1] += m * (square(d[0]) + square(d[2])), i[4] -= m * d[0] * d[2];
  i[2] += m * (square(d[0]) + square(d[1])), i[5] -= m * d[1] * d[2];
}

}  // namespace

bool has_mass_from_parts(const Body& body) {
  return body.density_kg_per_m3 || std::ranges::any_of(body.parts, [](const Part& part) {
           return std::holds_alternative<Weight>(part);
         });
}

namespace {
Mass given_mass(const Body& body) {
  const Vec3 &i = body.inertia_kg_m2, &p = body.products_kg_m2;
  return {body.mass_kg, body.com_m, {i[0], i[1], i[2], p[0], p[1], p[2]}};
}
}  // namespace

Mass combined(std::vector<Mass> masses) {
  Mass sum;  // until the last shift: com_m is Σ m r, and the inertia is about the origin
  for (Mass& mass : masses) {
    shift(mass, mass.com_m, 1);
    sum.mass_kg += mass.mass_kg;
    for (std::size_t k = 0; k < 3; ++k) sum.com_m[k] += mass.mass_kg * mass.com_m[k];
    for (std::size_t k = 0; k < 6; ++k) sum.inertia_kg_m2[k] += mass.inertia_kg_m2[k];
  }
  if (sum.mass_kg == 0) return sum;
  for (double& c : sum.com_m) c /= sum.mass_kg;
  shift(sum, sum.com_m, -1);
  return sum;
}

Mass mass_of(const Body& body) {
  if (!has_mass_from_parts(body)) return given_mass(body);
  const double density = body.density_kg_per_m3.value_or(0);
  std::vector<Mass> masses;
  for (const Part& part : body.parts)
    masses.push_back(std::visit([&](const auto& p) { return mass_of_part(p, density); }, part));
  return combined(std::move(masses));
}

}  // namespace erp
