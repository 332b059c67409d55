#include "sim/diagnosis/tries.hpp"

#include <algorithm>
#include <cmath>

namespace sim::diagnosis {
namespace {

/// A joint's stops, at or a little before where it turned back.
std::vector<effects::Placed> stops(const Trials& trials, const effects::Placed& neutral,
                                   std::span<const std::size_t> episodes) {
  const auto joints = trials.nominal().joints();
  const auto j = static_cast<std::size_t>(std::ranges::find(joints, neutral.on, &erp::Joint::name) -
                                          joints.begin());
  if (joints[j].type != erp::JointType::revolute) return {};
  double low = joints[j].max_rad, high = joints[j].min_rad;
  for (const std::size_t e : episodes) {
    const residuals::Episode& episode = trials.episodes()[e];
    const residuals::Signal& angle = episode.joints[j].angle_rad;
    for (std::size_t k = 0; k < angle.size(); ++k)
      if (episode.judged(k) && !std::isnan(angle[k]))
        low = std::min(low, angle[k]), high = std::max(high, angle[k]);
  }
  std::vector<effects::Placed> all;
  for (const double before_rad : {0.0, 0.01, 0.02, 0.035, 0.05})
    for (const int side : {1, 2, 3}) {
      all.push_back(neutral);
      const auto parameters = effects::parameters(all.back().effect);
      if (side & 1)
        *parameters[0].value =
            std::clamp(low - joints[j].min_rad + before_rad, 0.0, parameters[0].bounds.high);
      if (side & 2)
        *parameters[1].value =
            std::clamp(joints[j].max_rad - high + before_rad, 0.0, parameters[1].bounds.high);
    }
  return all;
}

/// How many parameters are not neutral.
std::size_t told(const effects::Placed& placed) {
  return effects::written(placed).parameters.size();
}

}  // namespace

bool is_neutral(const effects::Placed& placed) { return told(placed) == 0; }

std::vector<effects::Placed> tries(const Trials& trials, const effects::Placed& neutral,
                                   std::span<const std::size_t> episodes) {
  const auto type = effects::about(neutral.effect).type;
  if (type == "joint_early_stop") return stops(trials, neutral, episodes);
  std::vector<effects::Placed> all;
  constexpr double soft = 0.7, stiff = 0.01, ratio = 0.8;  // rad/Nm
  if (type == "skeleton_link_flexibility")
    for (double c = soft; c > stiff; c *= ratio) {
      all.push_back(neutral);
      *effects::parameters(all.back().effect)[0].value = c;
    }
  return all;
}

effects::Placed best_try(const Trials& trials, const Trial& base, const effects::Placed& more,
                         std::span<const std::size_t> episodes) {
  constexpr double worth = 0.01;  // of the gap, a parameter beyond the first; chosen
  effects::Placed best = more;
  if (!is_neutral(more)) return best;
  const ScoreBlock whole = sum(trials.blocks(base, episodes));
  const double before = whole.square,
               gap = std::max(0.0, before - static_cast<double>(whole.windows));
  auto all = tries(trials, more, episodes);
  for (const double share :
       {0.1, 0.02, -0.1}) {  // of the bounds: laws that are bent from the start
    all.push_back(more);
    const effects::Parameter first = effects::parameters(all.back().effect)[0];
    *first.value = share * (share > 0 ? first.bounds.high : -first.bounds.low);
    if (*first.value == 0) all.pop_back();
  }
  const auto cost = [&](const effects::Placed& one) {
    const std::size_t further = std::max<std::size_t>(1, told(one)) - 1;
    return sum(trials.blocks(trials.with(base, one, episodes), episodes)).square +
           worth * gap * static_cast<double>(further);
  };
  double least = before;
  for (const effects::Placed& one : all)
    if (const double of_one = cost(one); of_one < least) least = of_one, best = one;
  return best;
}

}  // namespace sim::diagnosis
