#pragma once
#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

/// Scores one diagnosis by the truth about its case: what counts as success, by kind of case.
namespace launch::gap {

using Json = nlohmann::ordered_json;

/// A success rate.
struct Rate {
  int yes = 0, of = 0;
  void count(bool is) { ++of, yes += is; }
  std::string text() const {
    return of ? fmt::format("{:5.1f} %  ({} of {})", 100.0 * yes / of, yes, of) : "-";
  }
};

/// Score of all cases of one kind.
struct Score {
  std::map<std::string, Rate> rates;
  std::vector<std::string> failures;
  double set_size = 0, group_size = 0, closed = 0, precision = 0, recall = 0;
  int sets = 0, groups = 0, closings = 0, answers = 0;
};

/// `most`: gap closure by the true effect, if the library has it.
void score_single(const Json& truth, const Json& d, std::optional<double> most, Score& score);
void score_none(const Json& truth, const Json& d, Score& score);
void score_pair(const Json& truth, const Json& d, Score& score);
void score_null(const Json& truth, const Json& d, Score& score);
/// Counts the intervals that contain the true number, for constants that the recordings determine.
void count_numbers(const Json& truth, const Json& d, Rate& rate);
/// Scores robots without a hidden effect whose constants deviate.
void score_tolerance(const Json& truth, const Json& d, const std::vector<std::string>& of_constants,
                     Score& score);

}  // namespace launch::gap
