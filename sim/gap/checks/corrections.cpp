#include "sim/gap/checks/corrections.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <span>

namespace sim::checks {
namespace {

constexpr double unit_tolerance = 0.25;     // of the logarithm of a factor; chosen
constexpr double largest_effect = 30;       // no effect of a robot changes a slope by more; chosen
constexpr std::size_t max_corrections = 8;  // of one recording; chosen

struct Unit {
  double factor;
  const char* remedy;
};

constexpr Unit degrees{180 / std::numbers::pi,
                       "the unit may be degrees: divide the column by 57.29578"};
constexpr Unit thousandths{
    1000, "the unit may be thousandths (mA, mN, mV, mm): divide the column by 1000"};
constexpr Unit thousands{1e-3, "the unit may be thousands (kN, km): multiply the column by 1000"};

std::vector<Unit> units_of(const Column& column, const erp::Robot& robot) {
  if (column.quantity == Quantity::angle) return {degrees, thousandths};
  if (column.quantity == Quantity::tension)
    return {thousandths,
            thousands,
            {1 / 9.81, "the unit may be kilograms: multiply the column by 9.81"}};
  if (column.quantity != Quantity::shaft) return {thousandths};
  const double ratio = robot.motor_of(robot.actuators[column.of]).gear_ratio;
  std::vector<Unit> units{degrees, thousandths, thousands};
  if (std::abs(std::log(ratio)) < unit_tolerance) return units;
  units.push_back({ratio,
                   "it may be the angle of the motor shaft before the gearbox: divide the column "
                   "by the gear ratio"});
  units.push_back(
      {1 / ratio,
       "it may be divided by the gear ratio twice: multiply the column by the gear ratio"});
  return units;
}

/// Whether the mean tension is positive. Tensions are positive because a tendon cannot push.
bool is_tension_positive(const Signal& tension) {
  double sum = 0;
  for (const double x : tension)
    if (std::isfinite(x)) sum += x;
  return sum > 0;
}

/// Whether no effect of a robot could cause the slope.
bool is_impossible(const Law& law) {
  return law.is_suspicious() &&
         !(law.line.slope < largest_effect && law.line.slope > 1 / largest_effect);
}

/// Applies the correction; a scaled column is divided by `factor`.
void apply(const Correction& correction, double factor, Means& means) {
  const auto& columns = correction.columns;
  if (correction.kind == Correction::Kind::scaled) means.scale(columns[0], 1 / factor);
  else
    for (std::size_t k = 0; 2 * k < columns.size(); ++k)
      means.exchange(columns[k], columns[k + columns.size() / 2]);
}

bool moves_bones(const Correction& correction) {
  return correction.columns[0].quantity == Quantity::angle;
}

/// Scores all corrections of the columns that take part in suspicious laws.
class Vote {
 public:
  Vote(const erp::Robot& robot, Laws& laws, Means& means)
      : robot_(robot), laws_(laws), means_(means) {
    for (std::size_t a = 0; a < means.actuators.size(); ++a) {
      before_.push_back(laws.evaluate(means, a));
      for (const Law& law : before_.back())
        if (law.is_suspicious())
          suspects_.insert(suspects_.end(), law.columns.begin(), law.columns.end());
        else if (law.is_inconclusive()) suspects_.push_back(law.columns.back());
    }
  }

  /// The corrections with the highest score; empty: no law is violated, or no correction helps.
  Alternatives best() {
    const auto all = residuals::all_columns(means_.actuators.size(), means_.joints.size());
    for (const Column& column : all) {
      for (const Unit& unit : units_of(column, robot_))
        for (const double sign : {1.0, -1.0}) try_scaled(column, sign * unit.factor, unit.remedy);
      try_scaled(column, -1, "");
    }
    try_exchanges();
    if (best_.empty()) test_any_factor();
    return best_;
  }

 private:
  void try_scaled(const Column& column, double factor, const char* remedy) {
    consider({Correction::Kind::scaled, {column}, factor, remedy, {}});
  }

  void try_exchanges() {
    const auto pair = [&](Quantity quantity, std::size_t a, std::size_t b) {
      consider({Correction::Kind::exchanged, {{quantity, a}, {quantity, b}}, 1, "", {}});
    };
    constexpr std::array converters{Quantity::voltage, Quantity::current, Quantity::tension};
    for (std::size_t a = 0; a < means_.actuators.size(); ++a)
      for (std::size_t k = 0; k < converters.size(); ++k)
        consider({Correction::Kind::exchanged,
                  {{converters[k], a}, {converters[(k + 1) % converters.size()], a}},
                  1,
                  "",
                  {}});
    for (std::size_t a = 0; a < means_.actuators.size(); ++a)
      for (std::size_t b = a + 1; b < means_.actuators.size(); ++b) {
        std::vector<Column> all_columns;
        for (const std::size_t of : {a, b})
          for (const Quantity q : residuals::actuator_quantities) all_columns.push_back({q, of});
        consider({Correction::Kind::exchanged, all_columns, 1, "", {}});
        for (const Quantity q : residuals::actuator_quantities) pair(q, a, b);
      }
    for (std::size_t i = 0; i < means_.joints.size(); ++i)
      for (std::size_t j = i + 1; j < means_.joints.size(); ++j) pair(Quantity::angle, i, j);
  }

  /// Tests the factors that would satisfy an impossible law. If no factor helps, reports the
  /// columns of the first impossible law as contradicting.
  void test_any_factor() {
    std::vector<Law> impossible;
    for (const auto& laws : before_)
      std::ranges::copy_if(laws, std::back_inserter(impossible), is_impossible);
    for (const Law& law : impossible)
      for (const Column& column : law.columns)
        for (const double factor : {law.line.slope, 1 / law.line.slope})
          try_scaled(column, factor, "");
    if (best_.empty() && !impossible.empty())
      best_.push_back({Correction::Kind::contradicting, impossible[0].columns, 1, "", {}});
  }

  /// A fast test before the evaluation: a wrong column takes part in a suspicious or inconclusive
  /// law. In an exchange, a column of each side does.
  bool is_possible(const Correction& correction) const {
    const auto suspect = [&](const Column& c) {
      return !means_[c].empty() && std::ranges::count(suspects_, c) > 0;
    };
    const std::span<const Column> columns = correction.columns;
    const auto first_half = columns.first(columns.size() / 2);
    if (correction.kind == Correction::Kind::exchanged)
      return std::ranges::any_of(first_half, suspect) &&
             std::ranges::any_of(columns.last(first_half.size()), suspect);
    const bool negates_tension = columns[0].quantity == Quantity::tension && correction.factor < 0;
    return suspect(columns[0]) && !(negates_tension && is_tension_positive(means_[columns[0]]));
  }

  /// Actuators whose laws the correction may change.
  std::vector<std::size_t> affected_actuators(const Correction& correction) const {
    std::vector<std::size_t> all;
    for (std::size_t a = 0; a < means_.actuators.size(); ++a) {
      const auto joints = laws_.crossed_by(a);
      if (std::ranges::any_of(correction.columns, [&](const Column& c) {
            return c.quantity == Quantity::angle ? std::ranges::count(joints, c) > 0 : c.of == a;
          }))
        all.push_back(a);
    }
    return all;
  }

  /// Scores a correction. An exchange changes more columns and must therefore score at least 2. Any
  /// other correction must repair at least one suspicious law; an inconclusive one is not enough.
  void consider(Correction correction) {
    if (!is_possible(correction)) return;
    const auto paths = moves_bones(correction) ? means_.paths : std::vector<residuals::PathTrace>{};
    apply(correction, correction.factor, means_);
    if (moves_bones(correction)) laws_.compute_paths(means_);
    Tally tally;
    for (const std::size_t a : affected_actuators(correction)) {
      const auto after = laws_.evaluate(means_, a);
      for (std::size_t k = 0; k < after.size() && after.size() == before_[a].size(); ++k)
        count(before_[a][k], after[k], correction, tally);
    }
    apply(correction, 1 / correction.factor, means_);
    if (moves_bones(correction)) means_.paths = paths;
    const bool is_sufficient =
        correction.kind == Correction::Kind::exchanged ? tally.gain > 1 : tally.suspicious > 0;
    if (is_sufficient && tally.gain > 0 && tally.gain >= gain_) store(std::move(correction), tally);
  }

  struct Tally {
    int gain = 0;          ///< score: repaired laws minus laws that become violated
    int suspicious = 0;    ///< repaired laws that were suspicious
    double deviation = 0;  ///< Σ |log slope| of the repaired laws
  };
  static void count(const Law& before, const Law& after, Correction& correction, Tally& tally) {
    const double deviation = std::abs(std::log(std::abs(after.line.slope)));
    const bool changes_unit = std::abs(correction.factor) != 1;
    tally.gain -= before.is_satisfied() && !after.is_satisfied();
    if (!(before.is_suspicious() || before.is_inconclusive()) || !after.is_satisfied() ||
        (changes_unit && deviation > unit_tolerance))
      return;
    ++tally.gain, tally.deviation += deviation, tally.suspicious += before.is_suspicious();
    for (const Column& c : after.columns)
      if (!std::ranges::count(correction.columns, c) && !std::ranges::count(correction.evidence, c))
        correction.evidence.push_back(c);
  }

  /// Keeps the corrections with the highest score; of two factors of one column, the one with the
  /// smaller deviation.
  void store(Correction correction, const Tally& tally) {
    if (tally.gain > gain_) best_.clear(), deviations_.clear();
    gain_ = tally.gain;
    for (std::size_t k = 0; k < best_.size(); ++k)
      if (best_[k].columns == correction.columns) {
        if (tally.deviation < deviations_[k])
          best_[k] = std::move(correction), deviations_[k] = tally.deviation;
        return;
      }
    best_.push_back(std::move(correction)), deviations_.push_back(tally.deviation);
  }

  const erp::Robot& robot_;
  Laws& laws_;
  Means& means_;
  std::vector<std::vector<Law>> before_;  ///< laws without a correction, by actuator
  std::vector<Column> suspects_;
  Alternatives best_;
  std::vector<double> deviations_;
  int gain_ = 0;
};

/// Drops an alternative whose columns are corrected by a later step.
void drop_alternatives_corrected_later(std::vector<Alternatives>& all) {
  for (auto step = all.begin(); step != all.end(); ++step)
    std::erase_if(*step, [&](const Correction& m) {
      return m.columns != (*step)[0].columns &&
             std::any_of(step + 1, all.end(),
                         [&](const Alternatives& later) { return later[0].columns == m.columns; });
    });
}

}  // namespace

std::vector<Alternatives> corrections(const erp::Robot& robot, Laws& laws, Means means) {
  std::vector<Alternatives> all;
  while (all.size() < max_corrections) {
    Alternatives best = Vote(robot, laws, means).best();
    if (best.empty()) break;
    const bool is_last = best[0].kind == Correction::Kind::contradicting;
    if (!is_last) apply(best[0], best[0].factor, means), laws.compute_paths(means);
    all.push_back(std::move(best));
    if (is_last) break;
  }
  drop_alternatives_corrected_later(all);
  return all;
}

}  // namespace sim::checks
