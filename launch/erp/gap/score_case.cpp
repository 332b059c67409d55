#include "launch/erp/gap/score_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/gap/estimation/as_built.hpp"

namespace launch::gap {
namespace {

std::string type_of(const Json& j) { return j["type"].get<std::string>(); }
std::string on_of(const Json& j) { return j["on"].get<std::string>(); }
bool same(const Json& a, const Json& b) { return type_of(a) == type_of(b) && on_of(a) == on_of(b); }

std::vector<Json> answer_of(const Json& diagnosis) {
  std::vector<Json> all;
  for (const Json& effect : diagnosis["effects"])
    if (effect["supported"].get<bool>()) all.push_back(effect);
  return all;
}

std::string hidden_text(const Json& truth) {
  std::string text;
  for (const Json& h : truth["hidden"]) {
    text += fmt::format("{}{} on {}", text.empty() ? "" : " + ", type_of(h), on_of(h));
    for (const auto& [name, value] : h["parameters"].items())
      text += fmt::format(" {}={:.3g}", name, value.get<double>());
  }
  return text;
}

std::string reported_text(const Json& diagnosis) {
  std::string text = diagnosis["verdict"].get<std::string>();
  for (const Json& effect : answer_of(diagnosis))
    text += fmt::format(", {} on {}", type_of(effect), on_of(effect));
  if (!diagnosis["where"].empty())
    text += fmt::format(" [{} {}]", diagnosis["where"][0]["stage"].get<std::string>(),
                        on_of(diagnosis["where"][0]));
  return text;
}

std::string failure(const Json& truth, const Json& diagnosis) {
  return fmt::format("{}: {} | {}", truth["case"].get<std::string>(), hidden_text(truth),
                     reported_text(diagnosis));
}

bool located(const Json& hidden, const Json& diagnosis) {
  return !diagnosis["where"].empty() && diagnosis["where"][0]["stage"] == hidden["stage"] &&
         diagnosis["where"][0]["on"] == hidden["on"];
}

/// Number of places with the largest share.
std::size_t group_size(const Json& diagnosis) {
  std::size_t size = 0;
  for (const Json& place : diagnosis["where"])
    size += place["share"] == diagnosis["where"][0]["share"];
  return size;
}

/// Whether the hidden effect is at one of the places with the largest share.
bool in_group(const Json& hidden, const Json& diagnosis) {
  for (const Json& place : diagnosis["where"])
    if (place["on"] == hidden["on"] && place["stage"] == hidden["stage"] &&
        place["share"] == diagnosis["where"][0]["share"])
      return true;
  return false;
}

/// Counts the intervals that contain the true value, for parameters that truth and diagnosis have in common.
void count_intervals(const Json& hidden, const Json& effect, Rate& rate) {
  for (const auto& [name, value] : hidden["parameters"].items())
    if (effect["intervals"].contains(name))
      rate.count(effect["intervals"][name][0] <= value && value <= effect["intervals"][name][1]);
}

/// Gap closure by the true effect. If the gap is within the noise, a percentage has no meaning.
std::string truth_closes(double share) {
  return share < 0 || share > 1.1 ? "a gap within the noise"
                                  : fmt::format("truth closes {:.0f} %", 100 * share);
}

/// Whether two effects are in the same set of equivalent effects.
bool equivalent(const Json& diagnosis, const Json& one, const Json& other) {
  for (const Json& a : diagnosis["confounders"])
    for (const Json& b : diagnosis["confounders"])
      if (a["set"] == b["set"] && same(a, one) && same(b, other)) return true;
  return false;
}

/// Whether an effect is the deviation of a constant.
bool is_constant(const Json& effect, const std::vector<std::string>& of_constants) {
  return std::ranges::count(of_constants, type_of(effect)) > 0;
}

/// The constant of a diagnosis that corresponds to a true number; null if there is none.
Json constant_of(const Json& number, const Json& d) {
  for (const Json& c : d["constants"])
    if (c["on"] == number["on"] && c["name"] == number["name"]) return c;
  return {};
}

/// Counts errors larger than their interval that are reported to differ, and reported errors of constants that are
/// exact.
void count_named(const Json& truth, const Json& d, Rate& reported, Rate& false_reports) {
  for (const Json& number : truth["numbers"]) {
    const Json c = constant_of(number, d);
    if (c.is_null()) continue;
    const double nominal = c["nominal"], error = number["value"].get<double>() - nominal;
    const double half = (c["interval"][1].get<double>() - c["interval"][0].get<double>()) / 2;
    if (std::abs(error) > 2 * half) reported.count(c["differs"]);
    if (c["differs"]) false_reports.count(std::abs(error) < 1e-9 * std::abs(nominal));
  }
}

}  // namespace

void score_single(const Json& truth, const Json& d, std::optional<double> most, Score& score) {
  const Json& hidden = truth["hidden"][0];
  const auto answer = answer_of(d);
  const bool first = !answer.empty() && same(answer[0], hidden);
  bool in_set = first;
  for (const Json& other : d["confounders"]) in_set |= same(other, hidden);
  score.rates["1 stage and place"].count(located(hidden, d));
  score.rates["5 stage and place in the group"].count(in_group(hidden, d));
  score.rates["2 true effect first"].count(first);
  score.rates["3 true effect in the set"].count(in_set);
  score.set_size += static_cast<double>(std::max<std::size_t>(1, d["confounders"].size()));
  ++score.sets;
  for (const Json& effect : d["effects"])
    if (same(effect, hidden))
      count_intervals(hidden, effect, score.rates["4 interval contains true value"]);
  score.rates["6 supported, but wrong stage"].count(d["verdict"] == "supported" && !in_set &&
                                                    !in_group(hidden, d));
  score.group_size += double(group_size(d)), score.groups += !d["where"].empty();
  constexpr double worth_closing = 0.02;
  if (most && *most > worth_closing)
    score.closed += d["gap"]["closed"].get<double>() / *most, ++score.closings;
  if (d["verdict"] != "supported" || !in_set || !located(hidden, d))
    score.failures.push_back(failure(truth, d) + (most ? " | " + truth_closes(*most) : ""));
}

void score_none(const Json& truth, const Json& d, Score& score) {
  const Json& hidden = truth["hidden"][0];
  const bool none = d["verdict"] == "none_of_the_known";
  const bool stage = !d["where"].empty() && d["where"][0]["stage"] == hidden["stage"];
  score.rates["1 none of the known"].count(none);
  score.rates["2 stage"].count(stage);
  score.rates["4 stage in the reported group"].count(in_group(hidden, d));
  score.group_size += double(group_size(d)), score.groups += !d["where"].empty();
  score.rates["3 place"].count(!d["where"].empty() && d["where"][0]["on"] == hidden["on"]);
  if (!none || !stage) score.failures.push_back(failure(truth, d));
}

void score_pair(const Json& truth, const Json& d, Score& score) {
  const auto answer = answer_of(d);
  const auto matches = [&](const Json& effect, const Json& hidden) {
    return same(effect, hidden) || equivalent(d, effect, hidden);
  };
  int found = 0, right = 0;
  for (const Json& hidden : truth["hidden"])
    found += std::ranges::any_of(answer, [&](const Json& a) { return matches(a, hidden); });
  for (const Json& a : answer)
    right += std::ranges::any_of(truth["hidden"], [&](const Json& h) { return matches(a, h); });
  score.rates["1 both effects in answer or set"].count(found == 2);
  score.precision += answer.empty() ? 0 : double(right) / double(answer.size());
  score.recall += found / 2.0, ++score.answers;
  if (found < 2) score.failures.push_back(failure(truth, d));
}

void score_null(const Json& truth, const Json& d, Score& score) {
  const bool alarm = d["verdict"] != "no_gap";
  score.rates["1 false alarms"].count(alarm);
  if (alarm)
    score.failures.push_back(
        fmt::format("{}: nothing | {}", truth["case"].get<std::string>(), reported_text(d)));
}

void count_numbers(const Json& truth, const Json& d, Rate& rate) {
  for (const Json& number : truth["numbers"])
    if (const Json c = constant_of(number, d);
        !c.is_null() && c["determined"] > sim::estimation::determined_threshold)
      rate.count(c["interval"][0] <= number["value"] && number["value"] <= c["interval"][1]);
}

void score_tolerance(const Json& truth, const Json& d, const std::vector<std::string>& of_constants,
                     Score& score) {
  const auto answer = answer_of(d);
  const bool structural =
      std::ranges::any_of(answer, [&](const Json& e) { return !is_constant(e, of_constants); });
  const bool explained = d["verdict"] == "supported" || d["verdict"] == "no_gap";
  const double closed = d["verdict"] == "no_gap" ? 1 : d["gap"]["closed"].get<double>();
  score.rates["1 explained by constants alone"].count(explained && !structural);
  score.rates["2 98 % of the gap closed"].count(closed >= 0.98);
  count_numbers(truth, d, score.rates["4 interval contains constant"]);
  if (const Json free = d["gap"].value("free_running", Json::object());
      !free.empty() && free["before"] > 1.5 * free["floor"].get<double>())
    score.rates["3 90 % closed in free run"].count(explained && free["closed"] >= 0.9);
  if (truth["kind"] == "many")
    count_named(truth, d, score.rates["5 visible errors reported"],
                score.rates["6 false among reported errors"]);
  if (!explained || structural) score.failures.push_back(failure(truth, d));
}

}  // namespace launch::gap
