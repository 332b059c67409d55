#pragma once
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "sim/gap/diagnosis/bootstrap.hpp"
#include "sim/model/effects/library.hpp"
#include "sim/gap/residuals/episode.hpp"

/// The bus, seen in what the ECUs did: which command, how old, they followed.
///
///   followed_k = sent_{k−a}                       a: the age in ticks; where both were recorded, else
///   V_k = law(reference_{k−a}, measured)          of the voltage that was applied
///
/// Ticks whose command is that before it tell no age. The law is that of the ECU firmware with the
/// gains designed for the robot (sim/control/gain_design), in length or force control; ticks at a limit
/// are left out. An effect on the bus foretells how often each age comes; effects are compared by
/// their likelihood. A recording whose voltages no command explains, of an ECU with another law, says
/// nothing of the bus.
namespace sim::diagnosis {

struct Ages {
  double period_s = 0;
  std::vector<std::size_t> ticks;   ///< how often each age was seen
  std::size_t told = 0, tried = 0;  ///< ticks whose age was found, of those with commands to tell
};

/// Of one recording, all actuators together.
Ages command_ages(const residuals::Episode& episode, const erp::Robot& robot);

struct BusFit {
  effects::Placed placed;
  double value = 0, low = 0, high = 0;
  double gain = 0;  ///< log-likelihood on the held-out recordings: none 0, the ages' own shares 1
  bool supported = false;
};

/// The bus's effects, best first; empty where the ages are all 0 or cannot be told.
std::vector<BusFit> fit_bus(std::span<const Ages> train, std::span<const Ages> held_out,
                            const erp::Robot& robot, const std::vector<std::string>& withhold);

/// More late ticks than a clock's drift leaves, as a share; chosen.
inline constexpr double practical_late = 0.02;

/// Enough ages were found, of enough ticks; else nothing is said of the bus.
bool told(std::span<const Ages> ages);

/// What a recording needs for that, in words.
inline constexpr const char* bus_is_told_by =
    "references that change from tick to tick: MCAP with the set-points sent and followed, or CSV "
    "with mode, reference as sent (erp log export writes those followed) and voltage_V, in length "
    "or "
    "force mode";

/// Of the commands that were followed, in the mean.
double mean_age_s(std::span<const Ages> ages);

/// The share of ticks in which a command was not the newest.
double late_share(std::span<const Ages> ages);

}  // namespace sim::diagnosis
