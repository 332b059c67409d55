#include "sim/model/actuator/muscle_jacobian.hpp"

#include <algorithm>

namespace sim {

Levers levers_of(const Routing& routing, const SkeletonModel& model) {
  const auto elements = routing.elements();
  const auto moves = [&](int coordinate, const PathElement& element) {
    return std::ranges::count(model.movers(element.body), coordinate) > 0;
  };
  Levers levers;
  levers.of_element.resize(elements.size());
  for (int d = 0; d < model.coordinates(); ++d) {
    const auto moved = std::ranges::count_if(elements, [&](const auto& e) { return moves(d, e); });
    if (moved == 0 || moved == std::ssize(elements)) continue;
    levers.coordinates.push_back(d);
    for (std::size_t k = 0; k < elements.size(); ++k)
      if (moves(d, elements[k])) levers.of_element[k].push_back(d);
  }
  return levers;
}

}  // namespace sim
