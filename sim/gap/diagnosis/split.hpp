#pragma once
#include <span>
#include <vector>

#include "sim/gap/diagnosis/localization.hpp"

/// Which recordings teach and which judge, by whole recordings.
namespace sim::diagnosis {

struct Sets {
  std::vector<std::size_t> train, held_out;  ///< indices of recordings
  std::vector<std::size_t> all() const;      ///< sorted, each once
};

/// Held out are those whose conditions lie farthest beyond the others', about a third.
Sets split(std::span<const residuals::Episode> episodes);

/// Each side must show the gap, to learn from and to judge by: if one does not, the recording that
/// shows the loudest stage second best is held out, if there are two.
Sets hold_out_visible(Sets sets, const Evaluator& plain, const LocalizationOptions& options);

/// A recording in two parts, of which the second is held out.
struct Cut {
  std::size_t episode, row;  ///< the second part's first
  effects::Stage stage;      ///< why: only one side would show that it is open
  std::string on;
};

/// Of the open stages that only one side shows, the recordings that show them best, each cut where
/// half of what shows has passed; none whose parts would not both show it.
std::vector<Cut> cuts(const Sets& sets, const Evaluator& plain, const LocalizationOptions& options);

/// The second part is a recording more, behind the others.
void cut_in_two(const Cut& cut, std::vector<residuals::Episode>& episodes, Sets& sets);

}  // namespace sim::diagnosis
