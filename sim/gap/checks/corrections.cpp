#include "sim/gap/checks/corrections.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <span>

namespace sim::checks {
namespace {

constexpr double unit_is_near = 0.25;  // in the logarithm; chosen
constexpr double beyond_all = 30;      // times: no effect of a robot is as large; chosen
constexpr std::size_t most = 8;        // mendings of one recording

struct Unit {
  double times;
  const char* like;
};

constexpr Unit degrees{180 / std::numbers::pi, "it looks like degrees: divide by 57.29578"};
constexpr Unit thousandths{
    1000, "it looks like thousandths of its unit (mA, mN, mV, mm): divide by 1000"};
constexpr Unit thousands{1e-3, "it looks like thousands of its unit: multiply by 1000"};

std::vector<Unit> units_of(const Column& column, const erp::Robot& robot) {
  if (column.quantity == Quantity::angle) return {degrees, thousandths};
  if (column.quantity == Quantity::tension)
    return {thousandths, thousands, {1 / 9.81, "it looks like kilograms: multiply by 9.81"}};
  if (column.quantity != Quantity::shaft) return {thousandths};
  const double ratio = robot.motor_of(robot.actuators[column.of]).gear_ratio;
  std::vector<Unit> units{degrees, thousandths, thousands};
  if (std::abs(std::log(ratio)) < unit_is_near) return units;
  units.push_back(
      {ratio, "it looks like the motor's shaft before the gearbox: divide by its ratio"});
  units.push_back(
      {1 / ratio, "it looks as if divided by the gear ratio once more: multiply by it"});
  return units;
}

/// A tendon cannot push.
bool pulls(const Signal& tension) {
  double sum = 0;
  for (const double x : tension)
    if (std::isfinite(x)) sum += x;
  return sum > 0;
}

/// No unit explains it, and no effect could.
bool absurd(const Law& law) {
  return law.suspicious() && !(law.line.slope < beyond_all && law.line.slope > 1 / beyond_all);
}

/// As if it were mended; of a scaled column `times` is what it is divided by.
void apply(const Correction& mending, double times, Means& means) {
  const auto& columns = mending.columns;
  if (mending.kind == Correction::Kind::scaled) means.scale(columns[0], 1 / times);
  else
    for (std::size_t k = 0; 2 * k < columns.size(); ++k)
      means.exchange(columns[k], columns[k + columns.size() / 2]);
}

bool moves_bones(const Correction& mending) {
  return mending.columns[0].quantity == Quantity::angle;
}

class Vote {
 public:
  Vote(const erp::Robot& robot, Laws& laws, Means& means)
      : robot_(robot), laws_(laws), means_(means) {
    for (std::size_t a = 0; a < means.actuators.size(); ++a) {
      before_.push_back(laws.held_against(means, a));
      for (const Law& law : before_.back())
        if (law.suspicious())
          suspects_.insert(suspects_.end(), law.columns.begin(), law.columns.end());
        else if (law.is_inconclusive()) suspects_.push_back(law.columns.back());
    }
  }

  /// Empty: nothing is wrong, or nothing helps.
  Either best() {
    const auto all = residuals::all_columns(means_.actuators.size(), means_.joints.size());
    for (const Column& column : all) {
      for (const Unit& unit : units_of(column, robot_))
        for (const double sign : {1.0, -1.0}) scaled(column, sign * unit.times, unit.like);
      scaled(column, -1, "");
    }
    exchanged();
    if (best_.empty()) of_no_unit();
    return best_;
  }

 private:
  void scaled(const Column& column, double times, const char* like) {
    consider({Correction::Kind::scaled, {column}, times, like, {}});
  }

  void exchanged() {
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
        std::vector<Column> whole;
        for (const std::size_t of : {a, b})
          for (const Quantity q : residuals::actuator_quantities) whole.push_back({q, of});
        consider({Correction::Kind::exchanged, whole, 1, "", {}});
        for (const Quantity q : residuals::actuator_quantities) pair(q, a, b);
      }
    for (std::size_t i = 0; i < means_.joints.size(); ++i)
      for (std::size_t j = i + 1; j < means_.joints.size(); ++j) pair(Quantity::angle, i, j);
  }

  /// Whatever factor would put a law right; and where none does, the law itself.
  void of_no_unit() {
    std::vector<Law> left;
    for (const auto& laws : before_) std::ranges::copy_if(laws, std::back_inserter(left), absurd);
    for (const Law& law : left)
      for (const Column& column : law.columns)
        for (const double times : {law.line.slope, 1 / law.line.slope}) scaled(column, times, "");
    if (best_.empty() && !left.empty())
      best_.push_back({Correction::Kind::contradicting, left[0].columns, 1, "", {}});
  }

  /// Before it is tried: a cause is in laws that are odd or silent, of an exchange on both sides.
  bool possible(const Correction& mending) const {
    const auto suspect = [&](const Column& c) {
      return !means_[c].empty() && std::ranges::count(suspects_, c) > 0;
    };
    const std::span<const Column> all = mending.columns, half = all.first(all.size() / 2);
    if (mending.kind == Correction::Kind::exchanged)
      return std::ranges::any_of(half, suspect) &&
             std::ranges::any_of(all.last(half.size()), suspect);
    const bool pushes = all[0].quantity == Quantity::tension && mending.times < 0;
    return suspect(all[0]) && !(pushes && pulls(means_[all[0]]));
  }

  /// Actuators whose laws it may change.
  std::vector<std::size_t> touched(const Correction& mending) const {
    std::vector<std::size_t> all;
    for (std::size_t a = 0; a < means_.actuators.size(); ++a) {
      const auto joints = laws_.crossed_by(a);
      if (std::ranges::any_of(mending.columns, [&](const Column& c) {
            return c.quantity == Quantity::angle ? std::ranges::count(joints, c) > 0 : c.of == a;
          }))
        all.push_back(a);
    }
    return all;
  }

  /// Laws put right less laws spoilt. An exchange, which changes more, must put two right; of
  /// another at least one law must have been odd, not only silent.
  void consider(Correction mending) {
    if (!possible(mending)) return;
    const auto paths = moves_bones(mending) ? means_.paths : std::vector<residuals::PathTrace>{};
    apply(mending, mending.times, means_);
    if (moves_bones(mending)) laws_.find_paths(means_);
    Tally tally;
    for (const std::size_t a : touched(mending)) {
      const auto after = laws_.held_against(means_, a);
      for (std::size_t k = 0; k < after.size() && after.size() == before_[a].size(); ++k)
        count(before_[a][k], after[k], mending, tally);
    }
    apply(mending, 1 / mending.times, means_);
    if (moves_bones(mending)) means_.paths = paths;
    const bool enough =
        mending.kind == Correction::Kind::exchanged ? tally.gain > 1 : tally.suspicious > 0;
    if (enough && tally.gain > 0 && tally.gain >= gain_) keep(std::move(mending), tally);
  }

  struct Tally {
    int gain = 0, suspicious = 0;  ///< right less spoilt; of the former, that were odd
    double off = 0;                ///< how far from 1 their slopes are, in logarithms
  };
  static void count(const Law& before, const Law& after, Correction& mending, Tally& tally) {
    const double how_far = std::abs(std::log(std::abs(after.line.slope)));
    const bool of_unit = std::abs(mending.times) != 1;
    tally.gain -= before.good() && !after.good();
    if (!(before.suspicious() || before.is_inconclusive()) || !after.good() ||
        (of_unit && how_far > unit_is_near))
      return;
    ++tally.gain, tally.off += how_far, tally.suspicious += before.suspicious();
    for (const Column& c : after.columns)
      if (!std::ranges::count(mending.columns, c) && !std::ranges::count(mending.evidence, c))
        mending.evidence.push_back(c);
  }

  /// Of two factors of one column, that which fits better.
  void keep(Correction mending, const Tally& tally) {
    if (tally.gain > gain_) best_.clear(), offs_.clear();
    gain_ = tally.gain;
    for (std::size_t k = 0; k < best_.size(); ++k)
      if (best_[k].columns == mending.columns) {
        if (tally.off < offs_[k]) best_[k] = std::move(mending), offs_[k] = tally.off;
        return;
      }
    best_.push_back(std::move(mending)), offs_.push_back(tally.off);
  }

  const erp::Robot& robot_;
  Laws& laws_;
  Means& means_;
  std::vector<std::vector<Law>> before_;  ///< by actuator
  std::vector<Column> suspects_;
  Either best_;
  std::vector<double> offs_;
  int gain_ = 0;
};

/// What is mended by itself later is no alternative to what was mended before.
void drop_later(std::vector<Either>& all) {
  for (auto either = all.begin(); either != all.end(); ++either)
    std::erase_if(*either, [&](const Correction& m) {
      return m.columns != (*either)[0].columns &&
             std::any_of(either + 1, all.end(),
                         [&](const Either& later) { return later[0].columns == m.columns; });
    });
}

}  // namespace

std::vector<Either> corrections(const erp::Robot& robot, Laws& laws, Means means) {
  std::vector<Either> all;
  while (all.size() < most) {
    Either best = Vote(robot, laws, means).best();
    if (best.empty()) break;
    const bool done = best[0].kind == Correction::Kind::contradicting;
    if (!done) apply(best[0], best[0].times, means), laws.find_paths(means);
    all.push_back(std::move(best));
    if (done) break;
  }
  drop_later(all);
  return all;
}

}  // namespace sim::checks
