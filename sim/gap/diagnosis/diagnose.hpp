#pragma once
#include <string>
#include <vector>

#include "sim/gap/diagnosis/attribution.hpp"
#include "sim/gap/diagnosis/gap_closure.hpp"
#include "sim/gap/diagnosis/joint_estimate.hpp"

/// The whole question: where robot and model part, which effect causes it, how far it closes the
/// gap; on recordings that were not used to choose or fit, or on such a part of one.
namespace sim::diagnosis {

enum class Verdict { no_gap, supported, none_of_the_known, not_identifiable };
const char* word(Verdict verdict);

/// A recording that teaches until then and judges from then on.
struct Shared {
  std::string recording;
  double judged_from_s;
};

struct Diagnosis {
  Verdict verdict = Verdict::no_gap;
  std::vector<Attribution> where;
  std::vector<Unexplained> unexplained;
  std::vector<StageGap> stages;          ///< of the nominal robot, all recordings
  std::vector<IdentifiedEffect> answer;  ///< effects that together close the gap
  std::vector<IdentifiedEffect> ranked;  ///< one by one, best first
  /// The robot as it was built, if that explains what a few effects alone do not: robot.xml's
  /// constants as estimated, with the effects of `answer` beside them.
  std::optional<erp::Robot> as_built;
  std::vector<ConstantEstimate> constants;  ///< of that robot
  double interaction = 0;  ///< of the gap: what the answer's effects close only together
  std::vector<WorstWindow> worst;
  Closed overall;
  std::vector<Closed> channels;
  std::vector<std::string> recordings, train, held_out, warnings;
  std::vector<std::string>
      fix_first;  ///< what is odd about the recordings; whoever read them tells
  std::vector<std::string> not_evaluated;  ///< stages and the bus, in words
  std::vector<Shared> shared;              ///< those that are in train and in held_out

  /// By other data than it was found on.
  bool uses_held_out_data() const { return train != held_out || !shared.empty(); }
};

/// The recordings tell the same signals (common_signals.hpp).
/// Throws std::invalid_argument: no recording, recordings in which no stage can be judged.
Diagnosis diagnose(const erp::Robot& robot, std::vector<residuals::Episode> episodes,
                   const DiagnoseOptions& options = {});

}  // namespace sim::diagnosis
