#pragma once
#include <string>
#include <vector>

#include "interfaces/robot/robot.hpp"

/// Load of a robot's buses, predicted from robot.xml.
///
/// Worst-case length of a frame, with all stuff bits:
///
///   classic, 11-bit identifier, n bytes:  g = 34 + 8 n;  bits = g + 13 + ⌊(g − 1)/4⌋
///     8 bytes: 135 bits (Davis et al., Real-Time Systems 35, 2007, eq. 1)
///   CAN FD, n bytes:  17 bits to the rate switch, ⌊16/4⌋ stuffed, 13 from the CRC delimiter to the
///     next frame, at the nominal rate; 5 + 8 n, a quarter of it stuffed, 4 of stuff count, CRC 17
///     (21 above 16 bytes) with 6 (7) fixed stuff bits, at the data rate (ISO 11898-1:2015)
///
/// Every 2 ms: a COMMAND to each ECU; from each ECU a STATUS per channel and an ANALOG for each
/// pair of inputs. Every 50 ms: a HEALTH.
namespace erp {

struct BusLoad {
  std::string bus;
  int ecus = 0;
  double share = 0;     ///< worst-case fraction of the time in which the bus is busy
  double period_s = 0;  ///< time on the bus of the frames of one 2 ms period
};

/// Largest accepted load; chosen. The remaining time is for PARAMETERs, EMERGENCYs and repeated
/// frames.
inline constexpr double max_load = 0.9;

/// Worst-case time of a frame with `bytes` of data, in s.
double frame_time_s(std::size_t bytes, double bitrate_per_s);
double fd_frame_time_s(std::size_t bytes, double bitrate_per_s, double data_bitrate_per_s);

/// One per bus of `robot.buses()`.
std::vector<BusLoad> bus_loads(const Robot& robot);

/// One line, "left: 4 ECUs, 82 % of its time".
std::string to_string(const BusLoad& load);

/// Throws xml::Errors for planned buses above `max_load`, with place, load and remedy. Accepts a
/// robot without a bus plan, because it may be used without a bus.
void refuse_overload(const Robot& robot);

}  // namespace erp
