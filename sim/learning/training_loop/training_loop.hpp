#pragma once
#include <functional>
#include <string>
#include <vector>

#include "interfaces/parallel/pool.hpp"

/// Training in rounds: run, checkpoint, resume, metrics. Independent of what is trained.
///
/// The state after a round depends only on the state before it and on the round's number (random
/// numbers come from `random_stream.hpp`), on one thread or many. A resumed run therefore gives the
/// same curve.
namespace sim::training_loop {

struct Metric {
  std::string name;  ///< with its unit: a column of the curve
  double value = 0;
};

class Training {
 public:
  virtual ~Training() = default;
  /// Runs one more round. The pool computes its parts.
  virtual void round(const Pool& pool) = 0;
  /// Number of completed rounds.
  virtual int rounds() const = 0;
  /// True: further rounds bring no improvement.
  virtual bool done() const { return false; }
  /// Quality of the current state; the same names after every round.
  virtual std::vector<Metric> metrics() const = 0;
  /// The complete state, as the text of an XML file.
  virtual std::string state() const = 0;
  /// Throws xml::Errors or std::invalid_argument if the text is the state of another training.
  virtual void restore(const std::string& text, const std::string& file) = 0;
};

struct LoopOptions {
  std::string folder;   ///< for state.xml and curve.csv
  int rounds = 0;       ///< total number, including resumed ones
  bool resume = false;  ///< continue from the checkpoint in the folder
  /// Called after each round in the first process. False stops the loop; the checkpoint is written.
  std::function<bool(const Training&)> on_round = [](const Training&) { return true; };
};

/// Trains until `rounds` rounds are complete or the training is done. After each round one row is
/// added to the curve, then state.xml is replaced. Both files are always complete. The first
/// process of the pool writes them. Throws std::invalid_argument if the folder holds a run and
/// `resume` is false, or holds none and `resume` is true; also what `restore` throws.
void run(Training& training, const LoopOptions& options, const Pool& pool = Threads());

}  // namespace sim::training_loop
