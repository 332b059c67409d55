#include "sim/model/actuator/routing.hpp"

#include <Eigen/Geometry>
#include <numbers>
#include <random>
#include <stdexcept>

#include "tests/bench/accuracy/figure.hpp"
#include "tests/sim/skeletons.hpp"

namespace accuracy {
namespace {

using sim::Vec3, sim::Wrap;

/// A sphere and two end points outside it, in a random plane through its centre.
struct Ends {
  double r_m, a_m, b_m;
  Eigen::Matrix3d plane;

  double alpha_rad() const { return std::acos(r_m / a_m); }
  double beta_rad() const { return std::acos(r_m / b_m); }
  double lift_off_rad() const { return alpha_rad() + beta_rad(); }
  Vec3 from_m() const { return plane * Vec3(a_m, 0, 0); }
  Vec3 to_m(double theta) const {
    return plane * Vec3(b_m * std::cos(theta), b_m * std::sin(theta), 0);
  }
  Wrap wrap(double theta) const {
    return sim::wrap_sphere(from_m(), to_m(theta), r_m, Vec3::Zero());
  }
  // L = √(a²−r²) + √(b²−r²) + r (θ − α − β)
  double wrapped_m(double theta) const {
    return std::sqrt(a_m * a_m - r_m * r_m) + std::sqrt(b_m * b_m - r_m * r_m) +
           r_m * (theta - lift_off_rad());
  }
  // L = |AB| = √(a² + b² − 2ab cos θ)
  double straight_m(double theta) const {
    return std::sqrt(a_m * a_m + b_m * b_m - 2 * a_m * b_m * std::cos(theta));
  }
  double error_m(double theta) const {
    const double exact_m = theta > lift_off_rad() ? wrapped_m(theta) : straight_m(theta);
    return std::abs(wrap(theta).length_m - exact_m);
  }
  // L'(θ₀ + 0) = L'(θ₀ − 0)
  double slope_jump_m() const {
    const double lift_off = lift_off_rad(), h = 1e-6, middle_m = wrap(lift_off).length_m;
    return std::abs(wrap(lift_off + h).length_m - 2 * middle_m + wrap(lift_off - h).length_m) / h;
  }
  // entry · (A − entry) = 0 = exit · (B − exit)
  double tangent_cosine(double theta) const {
    const Wrap line = wrap(theta);
    const Vec3 entry_direction = from_m() - line.entry_m,
               exit_direction = to_m(theta) - line.exit_m;
    return std::max(std::abs(line.entry_m.normalized().dot(entry_direction.normalized())),
                    std::abs(line.exit_m.normalized().dot(exit_direction.normalized())));
  }
};

/// Chosen: spheres with radii of 10 to 50 mm, end points up to five radii away.
Ends random_ends(std::mt19937& random) {
  std::uniform_real_distribution<double> radius_m(0.01, 0.05), distance_in_radii(1.05, 5),
      component(-1, 1);
  const double r_m = radius_m(random), a_m = r_m * distance_in_radii(random),
               b_m = r_m * distance_in_radii(random);
  const Eigen::Quaterniond plane(component(random), component(random), component(random),
                                 component(random));
  return {r_m, a_m, b_m, plane.normalized().toRotationMatrix()};
}

erp::Tendon tendon_over(const erp::Pulley& pulley, const erp::Attach& from, const erp::Attach& to) {
  erp::Tendon tendon = rigs::hinge_tendon();
  tendon.path = {from, pulley, to};
  return tendon;
}

/// Returns 1 if a path with an end at `depth` radii from the centre is accepted, else 0.
double accepted(double depth) {
  const double r_m = 0.03;  // chosen
  const std::vector<std::string> bodies{"base"};
  const sim::Routing routing(
      tendon_over({{}, "base", {0, 0, 0}, r_m}, {{}, "base", {0, 0, depth * r_m}},
                  {{}, "base", {0, 0, -0.2}}),
      bodies);
  try {
    routing.require_outside(std::vector<sim::BodyPose>(1));
    return 1;
  } catch (const std::invalid_argument&) {
    return 0;
  }
}

}  // namespace

Figures sphere_wrap() {
  double length_m = 0, opposite_m = 0, jump_m = 0, cosine = 0;
  std::mt19937 random(1);
  for (int evaluation = 0; evaluation < 1000; ++evaluation) {
    const Ends ends = random_ends(random);
    for (double theta = 1e-3; theta < std::numbers::pi; theta += 0.02) {
      length_m = larger(length_m, ends.error_m(theta));
      if (theta > ends.lift_off_rad()) cosine = larger(cosine, ends.tangent_cosine(theta));
    }
    opposite_m = larger(opposite_m, ends.error_m(std::numbers::pi - 1e-9));
    jump_m = larger(jump_m, ends.slope_jump_m());
  }
  double inside = 0;
  for (const double depth : {0.0, 0.5, 1 - 1e-9}) inside += accepted(depth);
  return {{1, "length around a sphere, 1000 spheres", length_m, 1e-12, "m"},
          {1, "length around a sphere, ends opposite within 1e-9 rad", opposite_m, 1e-12, "m"},
          {1, "jump of dL/dθ where the line leaves the sphere, differences over 1e-6 rad", jump_m,
           1e-5, "m/rad"},
          {1, "cosine between tangents and radii", cosine, 1e-12, ""},
          {1, "accepted paths with an end inside the sphere", inside, 0, "paths"}};
}

}  // namespace accuracy
