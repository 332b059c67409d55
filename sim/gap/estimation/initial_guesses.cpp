#include "sim/gap/estimation/initial_guesses.hpp"

#include <algorithm>
#include <cmath>

namespace sim::estimation {

std::vector<effects::Placed> initial_guesses(
    const effects::Placed& neutral, const erp::Robot& nominal,
    const std::vector<const residuals::Episode*>& recordings) {
  if (!std::holds_alternative<effects::JointEarlyStop>(neutral.effect)) return {};
  const auto joints = nominal.joints();
  const auto j = static_cast<std::size_t>(std::ranges::find(joints, neutral.on, &erp::Joint::name) -
                                          joints.begin());
  if (joints[j].type != erp::JointType::revolute) return {};
  double low = joints[j].max_rad, high = joints[j].min_rad;
  for (const residuals::Episode* recording : recordings) {
    const residuals::Signal& angle = recording->joints[j].angle_rad;
    for (std::size_t k = 0; k < angle.size(); ++k)
      if (recording->judged(k) && !std::isnan(angle[k]))
        low = std::min(low, angle[k]), high = std::max(high, angle[k]);
  }
  std::vector<effects::Placed> guesses;
  for (const double earlier_rad : {0.0, 0.01, 0.02, 0.035, 0.05})  // chosen
    for (const int side : {1, 2, 3}) {                             // bits: at min_rad, at max_rad
      effects::JointEarlyStop stop = std::get<effects::JointEarlyStop>(neutral.effect);
      const double max_rad_from_stop =
          effects::parameters(guesses.emplace_back(neutral).effect)[0].bounds.high;
      if (side & 1)
        stop.from_min_rad =
            std::clamp(low - joints[j].min_rad + earlier_rad, 0.0, max_rad_from_stop);
      if (side & 2)
        stop.from_max_rad =
            std::clamp(joints[j].max_rad - high + earlier_rad, 0.0, max_rad_from_stop);
      guesses.back().effect = stop;
    }
  return guesses;
}

}  // namespace sim::estimation
