#pragma once
#include <functional>
#include <string>
#include <vector>

#include "sim/diagnosis/bus.hpp"
#include "sim/diagnosis/shape.hpp"
#include "sim/diagnosis/which.hpp"

/// The whole question: where robot and model part, which effect causes it, how far it closes the
/// gap; on recordings that were not used to choose or fit.
namespace sim::diagnosis {

enum class Verdict { no_gap, supported, none_of_the_known, not_identifiable };
const char* word(Verdict verdict);

struct DiagnoseOptions {
  std::vector<std::size_t> train, held_out;  ///< recordings; both empty: split by the diagnosis
  std::vector<std::string> withhold;
  int threads = 2;
  std::uint64_t seed = 1;
  std::size_t most_effects = 3;
  /// A stage counts as explained when what is left of its excess is below this …
  double left_excess = 2;
  double search_excess = 1.5;  ///< the same, for another effect to be looked for
  /// … or below this share of what it was. All chosen on development cases.
  double left_share = 0.02;
  /// One effect alone may leave more, for a law of another shape: this share, or this one of the
  /// largest excess.
  double single_left_share = 0.05, single_left_of_most = 0.005;
  double least_gain = 0.02;  ///< of an effect, lower end of its interval, to be supported
  /// What is being done, and how much of it in 0 … 1.
  std::function<void(const std::string&, double)> progress = {};
};

/// An effect of the answer, or a candidate for it.
struct Named {
  std::string type, on;
  effects::Stage stage;
  std::vector<std::string> names;  ///< of its parameters
  std::vector<double> values;
  std::vector<Interval> intervals;  ///< 95 %
  double gain = 0;
  Interval gain_interval;
  bool supported = false;
  effects::Placed placed;
  std::vector<double> signature =
      {};               ///< of what it changes, the share at each of `Diagnosis::stages`
  double likeness = 0;  ///< cosine of what it changes to what the first of the answer changes
};

/// A few seconds of a stage's residual in a held-out recording, where it is worst.
struct Moment {
  effects::Stage stage;
  std::string on, unit, recording;
  double floor = 0;
  std::vector<double> time_s, before, after;
};

/// An error before and after, on held-out recordings.
struct Closed {
  std::string channel;  ///< stage and place, or "all"
  std::string unit;
  double before = 0, floor = 0, after = 0;  ///< rms
  double closed = 0;                        ///< (before − after)/(before − floor)
  Interval interval;
};

/// A part of the gap: a stage of the whole chain, bus to sensors, as far as it can be told.
struct Located {
  effects::Stage stage;
  std::string on;
  double share = 0;
  Interval interval;
  std::vector<Region> when;
};

/// What no effect explains.
struct Unexplained {
  effects::Stage stage;
  std::string on;
  double excess = 0;
  std::optional<Shape> shape;
};

struct Diagnosis {
  Verdict verdict = Verdict::no_gap;
  std::vector<Located> where;  ///< the largest share first
  std::vector<Unexplained> unexplained;
  std::vector<StageGap> stages;   ///< of the nominal robot, all recordings
  std::vector<StageGap> left;     ///< after the answer, held-out recordings
  std::vector<Named> answer;      ///< effects that together close the gap
  std::vector<Named> ranked;      ///< one by one, best first
  std::vector<Named> confusable;  ///< with the first of the answer
  std::vector<Moment> worst;
  Closed overall;
  std::vector<Closed> channels;
  std::vector<std::string> recordings, train, held_out, warnings;
};

/// Throws std::invalid_argument: no recording, recordings in which no stage can be judged.
Diagnosis diagnose(const erp::Robot& robot, std::vector<Episode> episodes,
                   const DiagnoseOptions& options = {});

/// Train and held out, by whole recordings: held out are those whose conditions lie farthest
/// beyond the others', about a third.
std::pair<std::vector<std::size_t>, std::vector<std::size_t>> split(
    std::span<const Episode> episodes);

}  // namespace sim::diagnosis
