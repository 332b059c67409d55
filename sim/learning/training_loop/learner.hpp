#pragma once
#include <functional>
#include <string>
#include <vector>

#include "interfaces/parallel/pool.hpp"

/// Anything that is learnt in rounds: how it is run, kept, gone on with and judged.
///
/// What a learner is after a round follows from what it was before and the round's number alone (dice
/// by `dice.hpp`), on one thread or many. So a run that was killed goes on to the same curve.
namespace sim::training_loop {

struct Metric {
  std::string name;  ///< with its unit: a column of the curve
  double value = 0;
};

class Learner {
 public:
  virtual ~Learner() = default;
  /// One more round, its parts done by the pool.
  virtual void round(const Pool& pool) = 0;
  /// So many are behind it.
  virtual int rounds() const = 0;
  /// True: another round would not better it.
  virtual bool done() const { return false; }
  /// How good it is now; the same names after every round.
  virtual std::vector<Metric> metrics() const = 0;
  /// All that it needs to go on, as the text of an XML file.
  virtual std::string state() const = 0;
  /// Throws xml::Errors, std::invalid_argument where the text is of another learner.
  virtual void restore(const std::string& text, const std::string& file) = 0;
};

struct Course {
  std::string folder;   ///< of state.xml and curve.csv
  int rounds = 0;       ///< in all
  bool resume = false;  ///< from what is in the folder
  /// After each round, in the first process; false: to end here, as if killed, all kept.
  std::function<bool(const Learner&)> told = [](const Learner&) { return true; };
};

/// Learns until `rounds` are behind it, or it is done. After each the curve has one row more, then state.xml is
/// replaced: either is whole at any time; the first process of the pool writes them. Throws
/// std::invalid_argument where the folder holds a run that is not to be resumed, or none that could
/// be; what `restore` throws.
void learn(Learner& learner, const Course& course, const Pool& pool = Threads());

}  // namespace sim::training_loop
