#include "launch/erp/gap/score_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "sim/gap/estimation/as_built.hpp"

namespace launch::gap {
namespace {

std::string type_of(const Json& j) { return j["type"].get<std::string>(); }
std::string on_of(const Json& j) { return j["on"].get<std::string>(); }
bool is_same_effect(const Json& a, const Json& b) {
  return type_of(a) == type_of(b) && on_of(a) == on_of(b);
}

std::vector<Json> answer_of(const Json& diagnosis) {
  std::vector<Json> effects;
  for (const Json& effect : diagnosis["effects"])
    if (effect["supported"].get<bool>()) effects.push_back(effect);
  return effects;
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

bool is_located(const Json& hidden, const Json& diagnosis) {
  return !diagnosis["where"].empty() && diagnosis["where"][0]["stage"] == hidden["stage"] &&
         diagnosis["where"][0]["on"] == hidden["on"];
}

/// Number of stages with the largest share.
std::size_t group_size(const Json& diagnosis) {
  std::size_t size = 0;
  for (const Json& place : diagnosis["where"])
    size += place["share"] == diagnosis["where"][0]["share"];
  return size;
}

/// Whether the hidden effect belongs to one of the stages with the largest share.
bool is_in_group(const Json& hidden, const Json& diagnosis) {
  for (const Json& place : diagnosis["where"])
    if (place["on"] == hidden["on"] && place["stage"] == hidden["stage"] &&
        place["share"] == diagnosis["where"][0]["share"])
      return true;
  return false;
}

/// Counts the intervals that contain the true value, for the parameters that both truth and
/// diagnosis contain.
void count_intervals(const Json& hidden, const Json& effect, Rate& rate) {
  for (const auto& [name, value] : hidden["parameters"].items())
    if (effect["intervals"].contains(name))
      rate.count(effect["intervals"][name][0] <= value && value <= effect["intervals"][name][1]);
}

/// Gap closure by the true effect. If the gap is within the noise, there is no percentage.
std::string true_closure_text(double closure) {
  constexpr double max_closure = 1.1;  // larger values come from noise; chosen
  return closure < 0 || closure > max_closure ? "a gap within the noise"
                                              : fmt::format("truth closes {:.0f} %", 100 * closure);
}

/// Whether two effects are in the same set of equivalent effects.
bool equivalent(const Json& diagnosis, const Json& one, const Json& other) {
  for (const Json& a : diagnosis["confounders"])
    for (const Json& b : diagnosis["confounders"])
      if (a["set"] == b["set"] && is_same_effect(a, one) && is_same_effect(b, other)) return true;
  return false;
}

/// Whether an effect is the deviation of a constant.
bool is_constant(const Json& effect, const std::vector<std::string>& constant_effects) {
  return std::ranges::count(constant_effects, type_of(effect)) > 0;
}

/// The constant in the diagnosis that corresponds to a number of the truth; null if there is none.
Json constant_of(const Json& number, const Json& d) {
  for (const Json& c : d["constants"])
    if (c["on"] == number["on"] && c["name"] == number["name"]) return c;
  return {};
}

/// `reported`: of the errors larger than the width of their interval, how many are reported.
/// `false_reports`: of the reported errors, how many belong to exact constants.
void count_reports(const Json& truth, const Json& d, Rate& reported, Rate& false_reports) {
  constexpr double rounding = 1e-9;  // relative, of numbers in the truth file; chosen
  for (const Json& number : truth["numbers"]) {
    const Json c = constant_of(number, d);
    if (c.is_null()) continue;
    const double nominal = c["nominal"], error = number["value"].get<double>() - nominal;
    const double half_interval =
        (c["interval"][1].get<double>() - c["interval"][0].get<double>()) / 2;
    if (std::abs(error) > 2 * half_interval) reported.count(c["differs"]);
    if (c["differs"]) false_reports.count(std::abs(error) < rounding * std::abs(nominal));
  }
}

}  // namespace

void score_single(const Json& truth, const Json& d, std::optional<double> true_closure,
                  Score& score) {
  const Json& hidden = truth["hidden"][0];
  const auto answer = answer_of(d);
  const bool is_first = !answer.empty() && is_same_effect(answer[0], hidden);
  bool is_in_set = is_first;
  for (const Json& other : d["confounders"]) is_in_set |= is_same_effect(other, hidden);
  score.rates["1 stage and place"].count(is_located(hidden, d));
  score.rates["5 stage and place in the group"].count(is_in_group(hidden, d));
  score.rates["2 true effect first"].count(is_first);
  score.rates["3 true effect in the set"].count(is_in_set);
  score.set_size += static_cast<double>(std::max<std::size_t>(1, d["confounders"].size()));
  ++score.sets;
  for (const Json& effect : d["effects"])
    if (is_same_effect(effect, hidden))
      count_intervals(hidden, effect, score.rates["4 interval contains true value"]);
  score.rates["6 supported, but wrong stage"].count(d["verdict"] == "supported" && !is_in_set &&
                                                    !is_in_group(hidden, d));
  score.group_size += double(group_size(d)), score.groups += !d["where"].empty();
  constexpr double min_closure = 0.02;  // below it, the gap is too small for a comparison; chosen
  if (true_closure && *true_closure > min_closure)
    score.closed += d["gap"]["closed"].get<double>() / *true_closure, ++score.closings;
  if (d["verdict"] != "supported" || !is_in_set || !is_located(hidden, d))
    score.failures.push_back(failure(truth, d) +
                             (true_closure ? " | " + true_closure_text(*true_closure) : ""));
}

void score_none(const Json& truth, const Json& d, Score& score) {
  const Json& hidden = truth["hidden"][0];
  const bool is_none_of_known = d["verdict"] == "none_of_the_known";
  const bool is_true_stage = !d["where"].empty() && d["where"][0]["stage"] == hidden["stage"];
  score.rates["1 none of the known"].count(is_none_of_known);
  score.rates["2 stage"].count(is_true_stage);
  score.rates["4 stage in the reported group"].count(is_in_group(hidden, d));
  score.group_size += double(group_size(d)), score.groups += !d["where"].empty();
  score.rates["3 place"].count(!d["where"].empty() && d["where"][0]["on"] == hidden["on"]);
  if (!is_none_of_known || !is_true_stage) score.failures.push_back(failure(truth, d));
}

void score_pair(const Json& truth, const Json& d, Score& score) {
  const auto answer = answer_of(d);
  const auto matches = [&](const Json& effect, const Json& hidden) {
    return is_same_effect(effect, hidden) || equivalent(d, effect, hidden);
  };
  int found_effects = 0, correct_effects = 0;
  for (const Json& hidden : truth["hidden"])
    found_effects += std::ranges::any_of(answer, [&](const Json& a) { return matches(a, hidden); });
  for (const Json& a : answer)
    correct_effects +=
        std::ranges::any_of(truth["hidden"], [&](const Json& h) { return matches(a, h); });
  score.rates["1 both effects in answer or set"].count(found_effects == 2);
  score.precision += answer.empty() ? 0 : double(correct_effects) / double(answer.size());
  score.recall += found_effects / 2.0, ++score.answers;
  if (found_effects < 2) score.failures.push_back(failure(truth, d));
}

void score_null(const Json& truth, const Json& d, Score& score) {
  const bool is_false_alarm = d["verdict"] != "no_gap";
  score.rates["1 false alarms"].count(is_false_alarm);
  if (is_false_alarm)
    score.failures.push_back(
        fmt::format("{}: nothing | {}", truth["case"].get<std::string>(), reported_text(d)));
}

void count_numbers(const Json& truth, const Json& d, Rate& rate) {
  for (const Json& number : truth["numbers"])
    if (const Json c = constant_of(number, d);
        !c.is_null() && c["determined"] > sim::estimation::determined_threshold)
      rate.count(c["interval"][0] <= number["value"] && number["value"] <= c["interval"][1]);
}

void score_tolerance(const Json& truth, const Json& d,
                     const std::vector<std::string>& constant_effects, Score& score) {
  const auto answer = answer_of(d);
  const bool has_structural_effect =
      std::ranges::any_of(answer, [&](const Json& e) { return !is_constant(e, constant_effects); });
  const bool is_explained = d["verdict"] == "supported" || d["verdict"] == "no_gap";
  const double closed = d["verdict"] == "no_gap" ? 1 : d["gap"]["closed"].get<double>();
  score.rates["1 explained by constants alone"].count(is_explained && !has_structural_effect);
  constexpr double min_closed = 0.98, min_closed_in_free_run = 0.9;  // as printed
  constexpr double visible_free_run_error = 1.5;  // times the noise floor; chosen
  score.rates["2 98 % of the gap closed"].count(closed >= min_closed);
  count_numbers(truth, d, score.rates["4 interval contains constant"]);
  if (const Json free = d["gap"].value("free_running", Json::object());
      !free.empty() && free["before"] > visible_free_run_error * free["floor"].get<double>())
    score.rates["3 90 % closed in free run"].count(is_explained &&
                                                   free["closed"] >= min_closed_in_free_run);
  if (truth["kind"] == "many")
    count_reports(truth, d, score.rates["5 visible errors reported"],
                  score.rates["6 false among reported errors"]);
  if (!is_explained || has_structural_effect) score.failures.push_back(failure(truth, d));
}

}  // namespace launch::gap
