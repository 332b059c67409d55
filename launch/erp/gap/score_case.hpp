#pragma once
#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

/// Compares one diagnosis with the truth about its case. Each kind of case has its own criteria of
/// success.
namespace launch::gap {

using Json = nlohmann::ordered_json;

/// A success rate.
struct Rate {
  int successes = 0, total = 0;
  void count(bool success) { ++total, successes += success; }
  std::string text() const {
    return total ? fmt::format("{:5.1f} %  ({} of {})", 100.0 * successes / total, successes, total)
                 : "-";
  }
};

/// Score of all cases of one kind.
struct Score {
  std::map<std::string, Rate> rates;
  std::vector<std::string> failures;
  double set_size = 0, group_size = 0, closed = 0, precision = 0, recall = 0;
  int sets = 0, groups = 0, closings = 0, answers = 0;
};

/// `true_closure`: gap closure by the true effect; empty if the library does not contain it.
void score_single(const Json& truth, const Json& d, std::optional<double> true_closure,
                  Score& score);
void score_none(const Json& truth, const Json& d, Score& score);
void score_pair(const Json& truth, const Json& d, Score& score);
void score_null(const Json& truth, const Json& d, Score& score);
/// Counts the intervals that contain the true number, for the constants that the recordings
/// determine.
void count_numbers(const Json& truth, const Json& d, Rate& rate);
/// Scores robots that have deviating constants and no hidden effect.
void score_tolerance(const Json& truth, const Json& d,
                     const std::vector<std::string>& constant_effects, Score& score);

}  // namespace launch::gap
