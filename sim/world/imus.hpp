#pragma once
#include <span>
#include <string>
#include <vector>

#include "interfaces/topics.hpp"
#include "sim/model/actuator/imu.hpp"
#include "sim/model/actuator/sampling.hpp"
#include "sim/world/world.hpp"

/// The inertial measurement units of a simulated robot. Each samples at its own rate; a sample arrives
/// after the unit's latency, stamped with the time at which it was taken.
namespace sim {

class Imus {
 public:
  /// `interval_s`: period of the calls of `sample`. Throws std::invalid_argument for an unknown body.
  Imus(const World& world, std::uint64_t seed, double interval_s);

  void sample(const World& world);
  /// The next time for which samples have arrived, with all units that sampled then; false: none.
  /// Sets stamp_ns and imus only.
  bool next(erp::ImuFrame& frame);

 private:
  struct Unit {
    std::string name;
    std::size_t body;
    ImuSensor sensor;
    Sampled<ImuReading> readings;
    double published_s = -1;  ///< time of the last sample that `next` returned
    double arrived_s = -1;    ///< time of the last sample that has arrived
  };
  std::vector<Unit> units_;
  double time_s_ = 0;
};

}  // namespace sim
