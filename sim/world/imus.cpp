#include "sim/world/imus.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace sim {
namespace {

erp::ImuSample sample_of(const std::string& name, const ImuReading& reading) {
  erp::ImuSample sample{};
  erp::assign(sample.name, name);
  for (int i = 0; i < 3; ++i) {
    sample.acceleration_m_per_s2[i] = reading.acceleration_m_per_s2[i];
    sample.turning_rad_per_s[i] = reading.turning_rad_per_s[i];
  }
  return sample;
}

}  // namespace

Imus::Imus(const World& world, std::uint64_t seed, double interval_s) {
  const xml::Vec3 g = world.robot().gravity_m_per_s2();
  std::uint64_t unit_seed =
      (seed << 16) + (1u << 15);  // distinct from the seeds of the ECUs' sensors
  for (const erp::Imu& imu : world.robot().imus) {
    const auto body = std::ranges::find(world.body_names(), imu.body);
    if (body == world.body_names().end())
      throw std::invalid_argument("imu \"" + imu.name + "\" is on body \"" + imu.body +
                                  "\", which the robot does not have");
    units_.push_back({imu.name,
                      static_cast<std::size_t>(body - world.body_names().begin()),
                      ImuSensor(imu, Vec3(g[0], g[1], g[2]), ++unit_seed),
                      {imu.sampling, interval_s}});
  }
}

void Imus::sample(const World& world) {
  time_s_ = world.time_s();
  for (Unit& unit : units_) {
    unit.readings.offer(time_s_, [&] {
      return unit.sensor.sample(time_s_, world.poses()[unit.body], world.twists()[unit.body]);
    });
    const auto& reading = unit.readings.latest(time_s_);
    if (unit.readings.arrived(reading, time_s_)) unit.arrived_s = reading.time_s;
  }
}

bool Imus::next(erp::ImuFrame& frame) {
  double earliest = std::numeric_limits<double>::infinity();
  for (const Unit& unit : units_)
    if (unit.arrived_s != unit.published_s) earliest = std::min(earliest, unit.arrived_s);
  if (!std::isfinite(earliest)) return false;
  frame.stamp_ns = std::llround(1e9 * earliest);
  frame.imus._length = 0;
  for (Unit& unit : units_) {
    if (unit.arrived_s != earliest || unit.published_s == earliest) continue;
    unit.published_s = earliest;
    erp::append(frame.imus, sample_of(unit.name, unit.readings.latest(time_s_).value));
  }
  return true;
}

}  // namespace sim
