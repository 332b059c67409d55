#include "sim/diagnosis/closing.hpp"

#include <cmath>

#include "sim/diagnosis/indices.hpp"

namespace sim::diagnosis {
namespace {

double closed_of(const Closed& c) {
  return c.before > c.floor ? (c.before - c.after) / (c.before - c.floor) : 0;
}

}  // namespace

std::vector<Closed> closed_by_stage(const Evidence& evidence, const Trials& plain,
                                    const std::vector<StageGap>& left) {
  std::vector<Closed> all;
  for (const StageGap& gap :
       where(plain, plain.bare(), evidence.sets.held_out, evidence.where_options())) {
    Closed c{std::string(effects::word(gap.stage)) + " " + gap.on, gap.unit, gap.rms, gap.floor};
    c.driven_by = gap.driven_by;
    c.after = find_stage(left, gap.stage, gap.on)->rms;
    c.closed = closed_of(c);
    all.push_back(c);
  }
  return all;
}

Closed closed_overall(const Evidence& evidence, const Trials& plain, const Trial& trial) {
  const auto& held_out = evidence.sets.held_out;
  const auto before = plain.blocks(plain.bare(), held_out);
  const auto after = plain.blocks(trial, held_out);
  const auto of = [&](const std::vector<std::size_t>& drawn) {
    Closed c{"all", "noise", 0, 1};
    double was = 0, is = 0, windows = 0;
    for (const std::size_t b : drawn)
      was += before[b].square, is += after[b].square, windows += double(before[b].windows);
    c.before = std::sqrt(was / std::max(windows, 1.0));
    c.after = std::sqrt(is / std::max(windows, 1.0));
    c.closed = closed_of(c);
    return c;
  };
  Closed whole = of(each(before.size()));
  whole.interval = middle(bootstrap(before.size(), 400, evidence.options.seed,
                                    [&](const auto& drawn) { return of(drawn).closed; }));
  return whole;
}

}  // namespace sim::diagnosis
