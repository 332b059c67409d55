#include "sim/model/actuator/path_line.hpp"
#include "sim/model/actuator/with_actuator_name.hpp"
#include "sim/world/world.hpp"

/// Tendons modelled as ropes.
namespace sim {

void World::make_ropes() {
  for (std::size_t k = 0; k < chains_.size(); ++k) {
    const erp::Actuator& actuator = robot_.actuators[k];
    Chain& chain = chains_[k];
    if (!actuator.rope) continue;
    chain.rope = std::make_unique<Rope>(*actuator.rope, chain.tendon, chain.routing,
                                        solids_of(robot_.bodies(), tree_.names));
    with_actuator_name(actuator, [&] { chain.rope->require_fine(chain.shape.length_m); });
    lay_rope(k, actuator.tendon.pretension_N);
  }
}

/// Places the rope along its path, at rest.
void World::lay_rope(std::size_t k, std::optional<double> pretension_N) {
  constexpr double arc_step_rad = 0.05;  // chosen
  Chain& chain = chains_[k];
  if (!chain.rope) return;
  chain.rope->lay(path_line(chain.routing, chain.shape, arc_step_rad), chain.state.shaft_rad);
  chain.rope->settle(poses(), chain.state.shaft_rad, pretension_N);
  readings_[k].length_m = chain.rope->length_m();
}

void World::add_rope_impulses(double dt_s) {
  for (const Chain& chain : chains_) {
    if (!chain.rope) continue;
    for (const BodyForce& force : chain.rope->forces()) {
      const Vec6 impulse = dt_s * wrench(force.at_m, force.force_N);
      for (const int d : model_->movers(force.body)) momentum_[d] += model_->axis(d).dot(impulse);
    }
  }
}

void World::move_ropes(double dt_s) {
  const xml::Vec3 g = robot_.gravity_m_per_s2();
  const Surroundings around{poses(), twists(), Vec3(g[0], g[1], g[2])};
  for (std::size_t k = 0; k < chains_.size(); ++k) {
    Chain& chain = chains_[k];
    if (!chain.rope) continue;
    chain.rope->step(around, chain.state.shaft_rad, dt_s);
    readings_[k].length_m = chain.rope->length_m();
  }
}

}  // namespace sim
