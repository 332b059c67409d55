#include "sim/gap/estimation/observable.hpp"

#include <algorithm>
#include <cmath>

#include "sim/gap/residuals/drives.hpp"

namespace sim::estimation {

using effects::Placed;

namespace {

/// The fraction of a shaft's travel in the less frequent direction, 0 … 0.5.
double reverse_fraction(std::span<const residuals::Episode> recordings, std::size_t actuator) {
  double forwards = 0, backwards = 0;
  for (const residuals::Episode& e : recordings) {
    const residuals::Signal& theta = e.actuators[actuator].shaft_rad;
    const auto valid = [&](std::size_t row) { return e.judged(row) && !std::isnan(theta[row]); };
    // Between compared rows; shorter travel has the sign of the noise.
    constexpr std::size_t rows = 10;
    for (std::size_t k = rows; k < theta.size(); k += rows)
      if (valid(k) && valid(k - rows)) {
        const double turned = theta[k] - theta[k - rows];
        (turned > 0 ? forwards : backwards) += std::abs(turned);
      }
  }
  return std::min(forwards, backwards) / std::max(forwards + backwards, 1e-12);
}

/// Whether an effect acts on a sensor that a drive lacks: a current that is commanded, or a tension
/// without a torque sensor.
bool acts_on_missing_sensor(const Placed& placed, const erp::Robot& robot, std::size_t actuator,
                            std::span<const residuals::Episode> recordings) {
  const auto sense = effects::sense_of(placed.effect);
  const erp::Drive* drive = sense ? residuals::drive_of(robot, placed.on) : nullptr;
  if (!drive) return false;
  if (sense == effects::Sense::tension) return !drive->find<erp::TorqueSensor>();
  return sense == effects::Sense::current &&
         std::ranges::any_of(recordings, [&](const residuals::Episode& e) {
           return e.actuators[actuator].current_around;
         });
}

}  // namespace

bool is_observable(const Placed& placed, const erp::Robot& robot,
                   std::span<const residuals::Episode> recordings) {
  constexpr double smallest_reverse_fraction = 0.02;  // chosen
  const std::size_t a =
      std::size_t(std::ranges::find(robot.actuators, placed.on, &erp::Actuator::name) -
                  robot.actuators.begin());
  if (acts_on_missing_sensor(placed, robot, a, recordings)) return false;
  return !std::holds_alternative<effects::GearboxAsymmetric>(placed.effect) ||
         reverse_fraction(recordings, a) > smallest_reverse_fraction;
}

}  // namespace sim::estimation
