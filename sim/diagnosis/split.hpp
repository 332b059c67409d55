#pragma once
#include <span>
#include <vector>

#include "sim/diagnosis/where.hpp"

/// Which recordings teach and which judge, by whole recordings.
namespace sim::diagnosis {

struct Sets {
  std::vector<std::size_t> train, held_out;  ///< indices of recordings
  std::vector<std::size_t> all() const;      ///< sorted, each once
};

/// Held out are those whose conditions lie farthest beyond the others', about a third.
Sets split(std::span<const Episode> episodes);

/// A recording held out that does not show the gap cannot judge: then the one that shows it second
/// best is held out, if there are two.
Sets hold_out_what_shows(Sets sets, const Trials& plain, const WhereOptions& options);

}  // namespace sim::diagnosis
