#pragma once
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "sim/gap/diagnosis/bootstrap.hpp"
#include "sim/gap/residuals/episode.hpp"
#include "sim/model/effects/library.hpp"

/// Age of the commands that the ECUs applied, and the bus effect that explains the distribution of
/// ages.
///
///   followed_k = sent_{k−a}                  if both set-points were recorded; a: age in ticks
///   V_k = law(reference_{k−a}, measured)     otherwise, from the applied voltage
///
/// Ticks whose command equals the previous one do not determine an age. The law is that of the ECU
/// firmware with the gains designed for the robot (sim/control/gain_design), in length or force
/// mode. Ticks at a limit are ignored. A bus effect predicts the frequency of each age; effects are
/// compared by their likelihood. If the voltages of a recording match no command (ECU with another
/// law), the bus is not evaluated.
namespace sim::diagnosis {

struct Ages {
  double period_s = 0;
  std::vector<std::size_t> ticks;  ///< number of ticks by age
  std::size_t checked = 0;         ///< ticks with a command that differs from the previous one
  std::size_t determined = 0;      ///< of these, ticks whose age was determined
};

/// Ages of one recording, over all actuators.
Ages command_ages(const residuals::Episode& episode, const erp::Robot& robot);

struct BusFit {
  effects::Placed placed;
  double value = 0, low = 0, high = 0;  ///< of the effect's only parameter, and its interval
  /// Log-likelihood on held-out recordings, scaled: 0 without an effect, 1 for the observed
  /// frequencies.
  double gain = 0;
  bool supported = false;
};

/// Fits the bus effects. Returns the best first. Empty if nearly all ages are 0, or too few ages
/// were determined. `withhold`: types of effects that are not tried.
std::vector<BusFit> fit_bus(std::span<const Ages> train, std::span<const Ages> held_out,
                            const erp::Robot& robot, const std::vector<std::string>& withhold);

/// The bus is reported as delayed if more than this fraction of ticks had a delayed command. Clock
/// drift causes less. Chosen.
inline constexpr double negligible_delayed_fraction = 0.02;

/// Whether enough ages were determined to evaluate the bus.
bool has_enough_ages(std::span<const Ages> ages);

/// Text for messages: what a recording must contain for an evaluation of the bus.
inline constexpr const char* bus_recording_needs =
    "set-points that change every tick, in length or force mode: MCAP with the set-points sent and "
    "followed, or CSV with mode, reference as sent (erp log export writes those followed) and "
    "voltage_V";

/// Mean age of the applied commands in s.
double mean_age_s(std::span<const Ages> ages);

/// Fraction of ticks in which the applied command was not the newest.
double delayed_fraction(std::span<const Ages> ages);

}  // namespace sim::diagnosis
