#pragma once
#include <span>
#include <string>
#include <vector>

#include "interfaces/topics.hpp"
#include "sim/model/actuator/imu.hpp"
#include "sim/model/actuator/sampling.hpp"
#include "sim/world/world.hpp"

/// The inertial units of a simulated robot: each looks at its own rate, and what it saw arrives
/// after its latency, stamped with the time it looked.
namespace sim {

class Imus {
 public:
  /// `interval_s`: how often `look` is called. Throws std::invalid_argument for an unknown body.
  Imus(const World& world, std::uint64_t seed, double interval_s);

  void look(const World& world);
  /// The next instant of which something arrived, with all units that looked then; false: none.
  /// Sets stamp_ns and imus only.
  bool next(erp::ImuFrame& frame);

 private:
  struct Unit {
    std::string name;
    std::size_t body;
    ImuSensor sensor;
    Sampled<ImuReading> readings;
    double said_s = -1;  ///< when it looked, of the last that was given out
    double seen_s = -1;  ///< of what has arrived
  };
  std::vector<Unit> units_;
  double time_s_ = 0;
};

}  // namespace sim
