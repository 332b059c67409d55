#pragma once
#include <span>
#include <vector>

#include "sim/gap/diagnosis/localization.hpp"

/// Split into training and held-out recordings.
namespace sim::diagnosis {

struct Sets {
  std::vector<std::size_t> train, held_out;  ///< indices of recordings
  std::vector<std::size_t> all() const;      ///< sorted, without duplicates
};

/// Holds out about a third: the recordings whose signals exceed the range of the others most.
Sets split(std::span<const residuals::Episode> episodes);

/// Ensures that both sets show the gap. If one does not, and at least two recordings show the stage
/// with the largest excess, the recording with the second largest excess is held out.
Sets hold_out_visible(Sets sets, const Evaluator& baseline, const LocalizationOptions& options);

/// A recording split in two parts, of which the second is held out.
struct Cut {
  std::size_t episode, row;  ///< recording, and first row of its second part
  effects::Stage stage;      ///< the stage that only one set shows without the cut
  std::string on;
};

/// For each open stage that only one set shows: the recording that shows it best, cut at half of
/// its excess. Omitted if one of the parts would not show the stage.
std::vector<Cut> cuts(const Sets& sets, const Evaluator& baseline,
                      const LocalizationOptions& options);

/// Cuts a recording. The second part is appended to `episodes`.
void cut_in_two(const Cut& cut, std::vector<residuals::Episode>& episodes, Sets& sets);

}  // namespace sim::diagnosis
