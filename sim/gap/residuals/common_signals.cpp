#include "sim/gap/residuals/common_signals.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/gap/residuals/measured.hpp"

namespace sim::residuals {
namespace {

bool has_no_sample(const Signal& signal) {
  return std::ranges::all_of(signal, [](double x) { return std::isnan(x); });
}

}  // namespace

void keep_common(std::vector<Episode>& episodes, const erp::Robot& robot,
                 std::vector<std::string>& remarks) {
  std::vector<std::vector<Measured<Episode>>> signals_of;
  for (Episode& episode : episodes) signals_of.push_back(measured(episode, robot));
  for (std::size_t n = 0; !signals_of.empty() && n < signals_of[0].size(); ++n) {
    const auto is_missing = [&](const auto& signals) { return has_no_sample(*signals[n].signal); };
    const auto incomplete = std::ranges::find_if(signals_of, is_missing);
    if (incomplete == signals_of.end()) continue;
    if (!std::ranges::all_of(signals_of, is_missing))
      remarks.push_back(fmt::format(
          "{}: lacks {}; this signal is ignored in the other recordings too",
          episodes[std::size_t(incomplete - signals_of.begin())].name, signals_of[0][n].column));
    for (const auto& signals : signals_of) signals[n].signal->clear();
  }
}

}  // namespace sim::residuals
