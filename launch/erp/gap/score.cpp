#include <fmt/format.h>

#include <fstream>
#include <map>
#include <ostream>

#include "launch/erp/gap/blind.hpp"
#include "launch/erp/gap/former_keys.hpp"
#include "launch/erp/gap/score_case.hpp"
#include "launch/erp/gap/truth.hpp"
#include "launch/erp/text/text_files.hpp"
#include "sim/gap/estimation/as_built.hpp"

namespace launch::gap {
namespace {

std::vector<std::string> effects_of_constants(const erp::Robot& robot) {
  std::vector<std::string> all;
  for (const auto& c : sim::estimation::constants_of(robot)) all.push_back(c.effect);
  return all;
}

void print(const std::string& kind, const Score& score, std::ostream& out) {
  out << kind << "\n";
  for (const auto& [name, rate] : score.rates)
    out << fmt::format("  {:<29} {}\n", name.substr(2), rate.text());
  if (score.sets > 0)
    out << fmt::format("  {:<29} {:5.2f}\n", "mean set size", score.set_size / score.sets);
  if (score.groups > 0)
    out << fmt::format("  {:<29} {:5.2f}\n", "mean group size", score.group_size / score.groups);
  if (score.closings > 0)
    out << fmt::format("  {:<29} {:5.1f} %\n", "closure relative to truth",
                       100 * score.closed / score.closings);
  if (score.answers > 0) {
    const double p = score.precision / score.answers, r = score.recall / score.answers;
    out << fmt::format("  {:<29} {:5.3f}\n", "F1", p + r > 0 ? 2 * p * r / (p + r) : 0);
  }
  if (!score.failures.empty()) out << "  failures: hidden | reported\n";
  for (const std::string& failure : score.failures) out << "    " << failure << "\n";
}

}  // namespace

int blind_score(const std::string& folder, const std::string& truth_file, std::ostream& out) {
  const Json manifest = Json::parse(read_text(folder + "/cases.json"));
  const std::string truth_text = read_text(truth_file);
  if (sha256(truth_text) != manifest["truth_sha256"])
    throw std::invalid_argument(truth_file + ": its hash differs from that of the truth of " +
                                folder + "; pass the --truth file of erp gap blind make");
  const Json truths = Json::parse(truth_text);
  std::vector<std::string> constant_effects;
  std::map<std::string, Score> scores;
  int missing = 0;
  for (const Json& truth : truths) {
    const std::string file = folder + "/" + truth["case"].get<std::string>() + "/diagnosis.json";
    if (!std::ifstream(file)) {
      ++missing;
      continue;
    }
    const Json d = parse_diagnosis<Json>(read_text(file), file);
    const bool is_as_built = !truth.value("numbers", Json::array()).empty();
    const std::string hidden_kind = truth["kind"],
                      kind =
                          hidden_kind + (is_as_built && hidden_kind != "many" ? ", as built" : "");
    Score& score = scores[kind];
    if (hidden_kind == "single") {
      score_single(truth, d, is_as_built ? std::nullopt : closed_by_truth(folder, truth), score);
      if (is_as_built) count_numbers(truth, d, score.rates["7 interval contains constant"]);
    }
    if (hidden_kind == "many" || (hidden_kind == "null" && is_as_built)) {
      if (constant_effects.empty())
        constant_effects = effects_of_constants(erp::read_robot(folder + "/robot.xml"));
      score_tolerance(truth, d, constant_effects, score);
    }
    if (hidden_kind == "null" && !is_as_built) score_null(truth, d, score);
    if (hidden_kind == "pair") score_pair(truth, d, score);
    if (hidden_kind == "outside" || hidden_kind == "withheld") score_none(truth, d, score);
  }
  for (const auto& [kind, score] : scores) print(kind, score, out);
  if (missing)
    out << fmt::format("{} of {} cases not diagnosed; run erp gap blind run {}\n", missing,
                       truths.size(), folder);
  return missing ? 5 : 0;
}

}  // namespace launch::gap
