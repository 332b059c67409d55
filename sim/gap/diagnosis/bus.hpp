#pragma once
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "sim/gap/diagnosis/bootstrap.hpp"
#include "sim/gap/residuals/episode.hpp"
#include "sim/model/effects/library.hpp"

/// Age of the commands that the ECUs followed, and the bus effect that explains its distribution.
///
///   followed_k = sent_{k−a}                       a: age in ticks, if both set-points were recorded;
///   V_k = law(reference_{k−a}, measured)          otherwise from the applied voltage
///
/// Ticks whose command equals the previous one do not determine an age. The law is that of the ECU
/// firmware with the gains designed for the robot (sim/control/gain_design), in length or force mode;
/// ticks at a limit are left out. An effect on the bus predicts the frequency of each age; effects are
/// compared by their likelihood. A recording whose voltages match no command (ECU with another law)
/// does not determine the bus.
namespace sim::diagnosis {

struct Ages {
  double period_s = 0;
  std::vector<std::size_t> ticks;  ///< number of ticks by age
  std::size_t checked = 0;         ///< ticks with a command that differs from the previous one
  std::size_t found = 0;           ///< of these, ticks whose age was found
};

/// Ages of one recording, over all actuators.
Ages command_ages(const residuals::Episode& episode, const erp::Robot& robot);

struct BusFit {
  effects::Placed placed;
  double value = 0, low = 0, high = 0;
  double gain =
      0;  ///< log-likelihood on held-out recordings, scaled: no effect 0, observed shares 1
  bool supported = false;
};

/// Effects on the bus, best first. Empty if nearly all ages are 0, or too few ages were found.
std::vector<BusFit> fit_bus(std::span<const Ages> train, std::span<const Ages> held_out,
                            const erp::Robot& robot, const std::vector<std::string>& withhold);

/// Share of late ticks above which the bus counts as late; clock drift alone causes less. Chosen.
inline constexpr double practical_late = 0.02;

/// Whether enough ages were found to evaluate the bus.
bool has_enough_ages(std::span<const Ages> ages);

/// What to record so that the bus can be evaluated; part of messages.
inline constexpr const char* bus_recording_needs =
    "set-points that change every tick, in length or force mode: MCAP with the set-points sent and "
    "followed, or CSV with mode, reference as sent (erp log export writes those followed) and "
    "voltage_V";

/// Mean age of the commands that were followed.
double mean_age_s(std::span<const Ages> ages);

/// Share of ticks in which the followed command was not the newest.
double late_share(std::span<const Ages> ages);

}  // namespace sim::diagnosis
