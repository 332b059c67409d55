#pragma once
#include <string>
#include <vector>

#include "interfaces/xml/fields.hpp"
#include "sim/world/world.hpp"

/// Loads that are attached to a simulated robot and detached again at given times.
namespace sim {

/// `<attached_load body="forearm" at_m="0 0 -0.26" mass_kg="0.2" at_s="1"/>` in the sim's config: a
/// point mass, in the body's frame, that moves with the body from the start (paper, Fig. 7b).
struct AttachedLoad {
  static constexpr auto element = "attached_load", former_element = "grasp";
  static constexpr auto description =
      "Point mass that is attached to a body; it moves with the body from the start (paper, Fig. "
      "7b).";
  xml::Place place;
  std::string body;
  xml::Vec3 at_m{0, 0, 0};
  double mass_kg = 0;
  double at_s = 0;
  double for_s = 1e9;
  void visit(auto& v) {
    v.required("body", body, "Body that carries the load.");
    v.required("at_m", at_m, "Position of the point mass in the frame of the body.");
    v.required("mass_kg", mass_kg, {xml::positive, "Mass of the load."});
    v.required("at_s", at_s, {xml::at_least_zero, "Simulated time at which the load is attached."});
    v("for_s", for_s, {xml::positive, "Time until the load is detached."});
  }
  bool is_attached(double time_s) const { return time_s >= at_s && time_s < at_s + for_s; }
};

class AttachedLoads {
 public:
  /// Throws std::invalid_argument for a body that the robot does not have or that cannot hold a
  /// load.
  AttachedLoads(std::vector<AttachedLoad> list, World& world)
      : list_(std::move(list)), was_attached_(list_.size()) {
    for (const AttachedLoad& load : list_) world.attach({mass_of(load, world)});
    world.attach({});
  }

  /// Attaches and detaches loads according to the world's time. Returns those that changed.
  std::vector<const AttachedLoad*> update(World& world) {
    std::vector<const AttachedLoad*> changed;
    std::vector<AttachedMass> attached;
    for (std::size_t k = 0; k < list_.size(); ++k) {
      const bool is_attached = list_[k].is_attached(world.time_s());
      if (is_attached != was_attached_[k]) changed.push_back(&list_[k]);
      was_attached_[k] = is_attached;
      if (is_attached) attached.push_back(mass_of(list_[k], world));
    }
    if (!changed.empty()) world.attach(attached);
    return changed;
  }

 private:
  static AttachedMass mass_of(const AttachedLoad& load, const World& world) {
    return {static_cast<int>(body_named(world.body_names(), load.body, "an attached load")),
            {load.at_m[0], load.at_m[1], load.at_m[2]},
            load.mass_kg};
  }

  std::vector<AttachedLoad> list_;
  std::vector<bool> was_attached_;
};

}  // namespace sim
