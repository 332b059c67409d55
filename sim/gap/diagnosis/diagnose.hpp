#pragma once
#include <string>
#include <vector>

#include "sim/gap/diagnosis/attribution.hpp"
#include "sim/gap/diagnosis/gap_closure.hpp"
#include "sim/gap/diagnosis/joint_estimate.hpp"

/// The whole diagnosis: localization, identification and gap closure, the latter on recordings that were
/// not used to select or fit, or on the held-out part of one.
namespace sim::diagnosis {

enum class Verdict { no_gap, supported, none_of_the_known, not_identifiable };
const char* word(Verdict verdict);

/// A split recording: training data until `judged_from_s`, held-out data from then on.
struct Shared {
  std::string recording;
  double judged_from_s;
};

struct Diagnosis {
  Verdict verdict = Verdict::no_gap;
  std::vector<Attribution> where;
  std::vector<Unexplained> unexplained;
  std::vector<StageGap> stages;          ///< of the nominal robot, all recordings
  std::vector<IdentifiedEffect> answer;  ///< effects that close the gap together
  std::vector<IdentifiedEffect> ranked;  ///< effects fitted one by one, best first
  /// The robot with estimated constants and the effects of `answer`, if these explain what a few effects
  /// alone do not.
  std::optional<erp::Robot> as_built;
  std::vector<ConstantEstimate> constants;  ///< of that robot
  double interaction = 0;  ///< share of the gap that the effects of the answer close only together
  std::vector<WorstWindow> worst;
  Closed overall;
  std::vector<Closed> channels;
  std::vector<std::string> recordings, train, held_out, warnings;
  std::vector<std::string> fix_first;  ///< suspicious columns; set by the reader of the recordings
  std::vector<std::string> not_evaluated;  ///< names of stages, and "bus"
  std::vector<Shared> shared;              ///< recordings in both train and held_out

  /// Whether the answer was checked on other data than it was fitted to.
  bool uses_held_out_data() const { return train != held_out || !shared.empty(); }
};

/// All recordings must contain the same signals (common_signals.hpp).
/// Throws std::invalid_argument without a recording, and for recordings in which no stage can be
/// evaluated.
Diagnosis diagnose(const erp::Robot& robot, std::vector<residuals::Episode> episodes,
                   const DiagnoseOptions& options = {});

}  // namespace sim::diagnosis
