#include <algorithm>
#include <stdexcept>

#include "sim/world/world.hpp"

/// The state of a world: all values on which a later step depends.
namespace sim {

WorldState World::save() const {
  WorldState state{
      time_s_, time_remainder_s_, {joints().begin(), joints().end()}, {}, {}, {}, {}, {},
      {},      attached_};
  for (const Chain& chain : chains_) {
    state.motors.push_back(chain.state);
    state.snapped.push_back(chain.snapped);
    state.around_rad.push_back(chain.shape.around_rad);
    if (chain.rope) state.ropes.push_back(chain.rope->state());
    chain.effects.save(state.effects);
    if (!chain.effects.empty())
      state.effects.push_back(
          {chain.wound.value, chain.wound.slope, chain.motor.type().resistance_ohm});
  }
  for (const JointEffects& joint : joint_effects_) joint.acting.save(state.effects);
  for (const ActuatorReading& reading : readings_) state.tension_N.push_back(reading.tension_N);
  return state;
}

void World::restore(const WorldState& state) {
  if (state.joints.size() != tree_.joints.size() || state.motors.size() != chains_.size() ||
      state.tension_N.size() != chains_.size() || state.snapped.size() != chains_.size() ||
      state.around_rad.size() != chains_.size() ||
      std::ssize(state.ropes) != std::ranges::count_if(chains_, &Chain::has_rope) ||
      state.effects.size() != save().effects.size())
    throw std::invalid_argument("the state belongs to a different robot");
  time_s_ = state.time_s, time_remainder_s_ = state.time_remainder_s;
  auto rope = state.ropes.begin();
  std::span<const effects::Memory> memories = state.effects;
  for (std::size_t k = 0; k < chains_.size(); ++k) {
    chains_[k].state = state.motors[k];
    chains_[k].snapped = state.snapped[k];
    chains_[k].shape.around_rad = state.around_rad[k];
    if (chains_[k].rope) chains_[k].rope->restore(*rope++);
    readings_[k].tension_N = state.tension_N[k];
    restore_effects(chains_[k], memories);
  }
  for (JointEffects& joint : joint_effects_) joint.acting.restore(memories);
  if (!attached_.empty() || !state.attached.empty()) attach(state.attached);
  bones_->place(state.joints);
  read();
}

}  // namespace sim
