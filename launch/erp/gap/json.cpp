#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "launch/erp/gap/files.hpp"

namespace launch::gap {
namespace {

using Json = nlohmann::ordered_json;
using namespace sim::diagnosis;

/// Rounds to five significant digits. The JSON library writes values that are not finite as null.
double rounded(double x) {
  if (x == 0 || !std::isfinite(x)) return x;
  const double scale = std::pow(10, 5 - std::ceil(std::log10(std::abs(x))));
  return std::round(x * scale) / scale;
}

Json pair_of(const Interval& i) { return Json::array({rounded(i.low), rounded(i.high)}); }

Json json_of(const Attribution& place) {
  Json when = Json::array();
  for (const Region& r : place.when)
    when.push_back({{"variable", r.variable}, {"fifth", r.fifth}, {"share", rounded(r.share)}});
  return {{"stage", sim::effects::word(place.stage)},
          {"on", place.on},
          {"share", rounded(place.share)},
          {"interval", pair_of(place.interval)},
          {"when", when}};
}

Json json_of(const IdentifiedEffect& n) {
  Json parameters = Json::object(), intervals = Json::object();
  for (std::size_t k = 0; k < n.names.size(); ++k)
    parameters[n.names[k]] = rounded(n.values[k]), intervals[n.names[k]] = pair_of(n.intervals[k]);
  return {{"type", n.type},           {"on", n.on},
          {"parameters", parameters}, {"intervals", intervals},
          {"gain", rounded(n.gain)},  {"gain_interval", pair_of(n.gain_interval)},
          {"supported", n.supported}};
}

Json json_of(const ClosedGap& c) {
  Json json{{"unit", c.unit},
            {"before", rounded(c.before)},
            {"floor", rounded(c.floor)},
            {"after", rounded(c.after)}};
  if (c.driven_by > 0) json["driven_by"] = rounded(c.driven_by);
  json["closed"] = rounded(c.closed);
  json["closed_interval"] = pair_of(c.interval);
  return json;
}

/// Channels by name. The closure of a channel without a gap is null.
Json channels_of(const std::vector<ClosedGap>& channels) {
  Json all = Json::object();
  for (const ClosedGap& c : channels) {
    Json& json = all[c.channel] = json_of(c);
    if (!c.has_gap()) json["closed"] = json["closed_interval"] = nullptr;
  }
  return all;
}

Json json_of(const StageGap& gap) {
  return {{"stage", sim::effects::word(gap.stage)},
          {"on", gap.on},
          {"unit", gap.unit},
          {"residual", rounded(gap.rms)},
          {"floor", rounded(gap.floor)},
          {"excess", rounded(gap.excess)},
          {"excess_interval", pair_of(gap.excess_interval)},
          {"share", rounded(gap.share)},
          {"windows", gap.windows},
          {"evaluated", gap.judged},
          {"open", gap.open}};
}

Json json_of(const ConstantEstimate& c) {
  return {{"name", c.name},
          {"on", c.on},
          {"stage", sim::effects::word(c.stage)},
          {"nominal", c.nominal},
          {"tolerance", rounded(c.tolerance)},
          {"value", rounded(c.value)},
          {"interval", pair_of(c.interval)},
          {"determined", rounded(std::clamp(c.determined, 0.0, 1.0))},
          {"differs", c.differs()},
          {"beyond", c.beyond}};
}

template <class Items>
Json list_of(const Items& items) {
  Json list = Json::array();
  for (const auto& item : items) list.push_back(json_of(item));
  return list;
}

/// The effects of the answer, then the other candidates in the order of their rank.
Json effects_of(const Diagnosis& d) {
  Json list = list_of(d.answer);
  for (const IdentifiedEffect& n : d.ranked)
    if (std::ranges::none_of(d.answer, [&](const IdentifiedEffect& a) {
          return a.type == n.type && a.on == n.on;
        })) {
      list.push_back(json_of(n));
      list.back()["supported"] = false;
    }
  return list;
}

/// Effects of the same `set` are equivalent.
Json confounders_of(const Diagnosis& d) {
  Json list = Json::array();
  int set = 0;
  for (const IdentifiedEffect& answer : d.answer) {
    if (answer.alternatives.empty()) continue;
    const auto add = [&](const IdentifiedEffect& n) {
      list.push_back(
          {{"type", n.type}, {"on", n.on}, {"set", set}, {"parameters", json_of(n)["parameters"]}});
    };
    add(answer);
    for (const IdentifiedEffect& other : answer.alternatives) add(other);
    ++set;
  }
  return list;
}

/// For each recording that serves training and validation: time at which its validation part
/// starts.
Json validation_starts(const sim::diagnosis::Diagnosis& d) {
  Json all = Json::object();
  for (const auto& entry : d.split_recordings) all[entry.recording] = entry.judged_from_s;
  return all;
}

}  // namespace

std::string diagnosis_json(const Diagnosis& d, const sim::closed_loop::FreeRun& free_run,
                           const erp::Robot& robot) {
  Json gap = json_of(d.overall);
  gap["channels"] = channels_of(d.channels);
  gap["interaction"] = rounded(d.interaction);
  if (!free_run.channels.empty()) {
    gap["free_running"] = json_of(free_run.all);
    gap["free_running"]["channels"] = channels_of(free_run.channels);
  }
  Json unexplained = Json::array();
  for (const Unexplained& u : d.unexplained) {
    Json entry{{"stage", sim::effects::word(u.stage)}, {"on", u.on}, {"excess", rounded(u.excess)}};
    if (u.shape) {
      entry["depends_on"] = u.shape->variable, entry["unit"] = u.shape->unit;
      entry["explained"] = rounded(u.shape->explained);
      entry["constant"] = rounded(u.shape->constant);
      entry["map"] = {
          {"at", u.shape->middle}, {"mean", u.shape->mean}, {"deviation", u.shape->deviation}};
    }
    unexplained.push_back(entry);
  }
  const Json all{{"format", "erp gap diagnosis 2"},
                 {"robot", robot.name},
                 {"verdict", word(d.verdict)},
                 {"where", list_of(d.where)},
                 {"effects", effects_of(d)},
                 {"confounders", confounders_of(d)},
                 {"constants", list_of(d.constants)},
                 {"gap", gap},
                 {"unexplained", unexplained},
                 {"residuals", list_of(d.stages)},
                 {"recordings", d.recordings},
                 {"train", d.train},
                 {"held_out", d.held_out},
                 {"held_out_from_s", validation_starts(d)},
                 {"fix_first", d.fix_first},
                 {"warnings", d.warnings}};
  return all.dump(1) + "\n";
}

}  // namespace launch::gap
