#pragma once
#include <string>
#include <vector>

#include "sim/gap/diagnosis/attribution.hpp"
#include "sim/gap/diagnosis/gap_closure.hpp"
#include "sim/gap/diagnosis/joint_estimate.hpp"

/// The whole diagnosis: localization, identification and gap closure. Gap closure is evaluated on
/// recordings, or on the part of a recording, that were not used for fits.
namespace sim::diagnosis {

enum class Verdict { no_gap, supported, none_of_the_known, not_identifiable };
/// Name of a verdict in diagnosis.json.
const char* word(Verdict verdict);

/// A split recording: training data until `judged_from_s`, held-out data from then on.
struct SplitRecording {
  std::string recording;
  double judged_from_s;
};

struct Diagnosis {
  Verdict verdict = Verdict::no_gap;
  std::vector<Attribution> where;
  std::vector<Unexplained> unexplained;
  std::vector<StageGap> stages;          ///< of the nominal robot, all recordings
  std::vector<IdentifiedEffect> answer;  ///< effects that jointly close the gap
  std::vector<IdentifiedEffect> ranked;  ///< effects fitted one by one, best first
  /// The robot with estimated constants and the effects of `answer`, if effects alone do not
  /// explain the gap.
  std::optional<erp::Robot> as_built;
  std::vector<ConstantEstimate> constants;  ///< of that robot
  double interaction =
      0;  ///< fraction of the gap that the effects of the answer close only jointly
  std::vector<WorstWindow> worst;
  ClosedGap overall;
  std::vector<ClosedGap> channels;
  std::vector<std::string> recordings, train, held_out, warnings;
  std::vector<std::string> fix_first;  ///< suspicious columns; set by the reader of the recordings
  std::vector<std::string> not_evaluated;        ///< names of stages, and "bus"
  std::vector<SplitRecording> split_recordings;  ///< recordings in both train and held_out

  /// Whether the answer was evaluated on other data than the data of its fit.
  bool uses_held_out_data() const { return train != held_out || !split_recordings.empty(); }
};

/// Diagnoses recordings of a robot. All recordings must have the same signals (common_signals.hpp).
/// Throws std::invalid_argument without a recording, and for recordings in which no stage can be
/// evaluated.
Diagnosis diagnose(const erp::Robot& robot, std::vector<residuals::Episode> episodes,
                   const DiagnoseOptions& options = {});

}  // namespace sim::diagnosis
