#pragma once
#include <string>
#include <vector>

#include "interfaces/xml/fields.hpp"
#include "sim/world/world.hpp"

/// What a simulated robot takes up and lets go, and when.
namespace sim {

/// `<grasp body="forearm" at_m="0 0 -0.26" mass_kg="0.2" at_s="1"/>` in the sim's config: a weight
/// of no size, in the body's frame, which moves with the body at once (paper, Fig. 7b).
struct Grasp {
  static constexpr auto element = "grasp";
  xml::Place place;
  std::string body;
  xml::Vec3 at_m{0, 0, 0};
  double mass_kg = 0;
  double at_s = 0;  ///< of simulated time
  double for_s = 1e9;
  void visit(auto& v) {
    v.required("body", body);
    v.required("at_m", at_m);
    v.required("mass_kg", mass_kg, xml::positive);
    v.required("at_s", at_s, xml::at_least_zero);
    v("for_s", for_s, xml::positive);
  }
  bool holds(double time_s) const { return time_s >= at_s && time_s < at_s + for_s; }
};

class Grasps {
 public:
  /// Throws std::invalid_argument for a body that the robot does not have or that cannot carry.
  Grasps(std::vector<Grasp> list, World& world) : list_(std::move(list)), held_(list_.size()) {
    for (const Grasp& grasp : list_) world.carry({carried(grasp, world)});
    world.carry({});
  }

  /// Gives the world what is held now; returns what has been taken up or let go by that.
  std::vector<const Grasp*> befall(World& world) {
    std::vector<const Grasp*> changed;
    std::vector<Carried> now;
    for (std::size_t k = 0; k < list_.size(); ++k) {
      const bool holds = list_[k].holds(world.time_s());
      if (holds != held_[k]) changed.push_back(&list_[k]);
      held_[k] = holds;
      if (holds) now.push_back(carried(list_[k], world));
    }
    if (!changed.empty()) world.carry(now);
    return changed;
  }

 private:
  static Carried carried(const Grasp& grasp, const World& world) {
    return {static_cast<int>(body_named(world.body_names(), grasp.body, "a grasp")),
            {grasp.at_m[0], grasp.at_m[1], grasp.at_m[2]},
            grasp.mass_kg};
  }

  std::vector<Grasp> list_;
  std::vector<bool> held_;
};

}  // namespace sim
