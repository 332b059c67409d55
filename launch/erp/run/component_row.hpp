#pragma once
#include "components/node/histogram.hpp"
#include "interfaces/topics.hpp"
#include "launch/erp/run/status_table.hpp"

namespace launch {

/// Copies the measurements in the heartbeat of a component to its table row.
inline void fill_measurements(Row& row, const erp::ComponentState& state) {
  row.pid = state.pid;
  row.rate_Hz = state.rate_Hz;
  row.age_p50_us = node::quantile_us(state.age_bins, 0.5);
  row.age_p99_us = node::quantile_us(state.age_bins, 0.99);
  row.jitter_p99_us = node::quantile_us(state.jitter_bins, 0.99);
  row.overruns = state.overruns;
  row.missed = state.missed;
  row.note = state.note;
}

}  // namespace launch
