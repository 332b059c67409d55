#pragma once
#include <cstdint>
#include <deque>

#include "interfaces/topics.hpp"
#include "sim/model/actuator/noise.hpp"
#include "sim/model/effects/acting.hpp"

/// The bus between plant and ECUs, with its effects: commands and frames in the order they were
/// sent, each when its delay is over; a frame that has not arrived leaves the one before.
namespace sim {

class BusEffects {
 public:
  BusEffects() = default;
  BusEffects(effects::Acting acting, std::uint64_t seed)
      : acting_(std::move(acting)), draw_(seed) {}
  /// Nothing acts: commands and frames need not come here.
  bool empty() const { return acting_.empty(); }

  /// A command sets out, at the time of the last frame kept.
  void send(const erp::EcuCommand& command);
  /// The next command that has arrived, until the next call; null: none.
  const erp::EcuCommand* arrived(double time_s);

  /// A frame sets out.
  void keep(const erp::EcuFrame& frame, double time_s);
  /// The newest that has arrived, or the first ever.
  const erp::EcuFrame& heard() const { return frames_.front().what; }

 private:
  template <class What>
  struct Travelling {
    double due_s;
    What what;
  };
  template <class What>
  void set_out(std::deque<Travelling<What>>& line, double due_s, const What& what) {
    line.push_back({line.empty() ? due_s : std::max(due_s, line.back().due_s), what});
  }
  effects::Acting acting_;
  Noise draw_{0};
  double now_s_ = 0;
  std::deque<Travelling<erp::EcuCommand>> commands_;
  erp::EcuCommand taken_;
  std::deque<Travelling<erp::EcuFrame>> frames_;
};

}  // namespace sim
