#include "sim/soundness/mending.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

namespace sim::soundness {
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
  return law.odd() && !(law.line.slope < beyond_all && law.line.slope > 1 / beyond_all);
}

Means mended(const Means& means, const Mending& mending, Laws& laws) {
  Means as_if = means;
  const auto& columns = mending.columns;
  if (mending.kind == Mending::Kind::scaled) as_if.scale(columns[0], 1 / mending.times);
  else
    for (std::size_t k = 0; 2 * k < columns.size(); ++k)
      as_if.exchange(columns[k], columns[k + columns.size() / 2]);
  if (columns[0].quantity == Quantity::angle) laws.find_paths(as_if);
  return as_if;
}

class Vote {
 public:
  Vote(const erp::Robot& robot, Laws& laws, const Means& means)
      : robot_(robot), laws_(laws), means_(means), before_(laws.held_against(means)) {
    for (const Law& law : before_)
      if (law.odd()) suspects_.insert(suspects_.end(), law.columns.begin(), law.columns.end());
      else if (law.silent()) suspects_.push_back(law.columns.back());
  }

  /// Empty: nothing is wrong, or nothing helps.
  Either best() {
    const auto all = residuals::all_columns(means_.actuators.size(), means_.joints.size());
    for (const Column& column : all)
      for (const Unit& unit : units_of(column, robot_))
        for (const double sign : {1.0, -1.0}) scaled(column, sign * unit.times, unit.like);
    for (const Column& column : all) scaled(column, -1, "");
    exchanged();
    if (!best_.empty()) return best_;
    for (const Law& law : before_)
      if (absurd(law))
        for (const Column& column : law.columns)
          for (const double times : {law.line.slope, 1 / law.line.slope}) scaled(column, times, "");
    if (!best_.empty()) return best_;
    const auto left = std::ranges::find_if(before_, absurd);
    if (left != before_.end())
      best_.push_back({Mending::Kind::contradicting, left->columns, 1, "", {}});
    return best_;
  }

 private:
  void scaled(const Column& column, double times, const char* like) {
    consider({Mending::Kind::scaled, {column}, times, like, {}});
  }

  void exchanged() {
    for (std::size_t a = 0; a < means_.actuators.size(); ++a)
      for (std::size_t b = a + 1; b < means_.actuators.size(); ++b) {
        std::vector<Column> whole;
        for (const std::size_t of : {a, b})
          for (const Quantity quantity : residuals::actuator_quantities)
            whole.push_back({quantity, of});
        consider({Mending::Kind::exchanged, whole, 1, "", {}});
        for (const Quantity quantity : residuals::actuator_quantities)
          consider({Mending::Kind::exchanged, {{quantity, a}, {quantity, b}}, 1, "", {}});
      }
    for (std::size_t i = 0; i < means_.joints.size(); ++i)
      for (std::size_t j = i + 1; j < means_.joints.size(); ++j)
        consider(
            {Mending::Kind::exchanged, {{Quantity::angle, i}, {Quantity::angle, j}}, 1, "", {}});
  }

  bool possible(const Mending& mending) const {
    const auto suspect = [&](const Column& c) { return std::ranges::count(suspects_, c) > 0; };
    const Column& first = mending.columns[0];
    if (mending.kind == Mending::Kind::scaled)
      return suspect(first) && !means_[first].empty() &&
             (first.quantity != Quantity::tension || mending.times > 0 || !pulls(means_[first]));
    const std::span<const Column> all = mending.columns, half = all.first(all.size() / 2);
    const auto told = [&](const Column& c) { return !means_[c].empty(); };
    return std::ranges::any_of(half, suspect) &&
           std::ranges::any_of(all.last(half.size()), suspect) && std::ranges::any_of(all, told);
  }

  /// Laws put right less laws spoilt, and how far from 1 the slopes of the former are.
  void consider(Mending mending) {
    if (!possible(mending)) return;
    const auto after = laws_.held_against(mended(means_, mending, laws_));
    if (after.size() != before_.size()) return;
    const bool unit = std::abs(mending.times) != 1;
    const bool exchange =
        mending.kind == Mending::Kind::exchanged;  // may silence two laws, no more
    int gain = 0, mended_odd = 0;
    double off = 0;
    for (std::size_t k = 0; k < after.size(); ++k) {
      const double how_far = std::abs(std::log(std::abs(after[k].line.slope)));
      if (before_[k].good() && !after[k].good()) --gain;
      const bool wrong = before_[k].odd() || before_[k].silent();
      if (!wrong || !after[k].good() || (unit && how_far > unit_is_near)) continue;
      ++gain, off += how_far, mended_odd += before_[k].odd();
      for (const Column& c : after[k].columns)
        if (!std::ranges::count(mending.columns, c) && !std::ranges::count(mending.told_by, c))
          mending.told_by.push_back(c);
    }
    const bool enough = exchange ? gain > 1 : gain > 0 && mended_odd > 0;
    if (enough && gain >= gain_) keep(std::move(mending), gain, off);
  }

  /// Of two factors of one column, that which fits better.
  void keep(Mending mending, int gain, double off) {
    if (gain > gain_) best_.clear(), offs_.clear();
    gain_ = gain;
    for (std::size_t k = 0; k < best_.size(); ++k)
      if (best_[k].columns == mending.columns) {
        if (off < offs_[k]) best_[k] = std::move(mending), offs_[k] = off;
        return;
      }
    best_.push_back(std::move(mending)), offs_.push_back(off);
  }

  const erp::Robot& robot_;
  Laws& laws_;
  const Means& means_;
  std::vector<Law> before_;
  std::vector<Column> suspects_;
  Either best_;
  std::vector<double> offs_;
  int gain_ = 0;
};

}  // namespace

std::vector<Either> mendings(const erp::Robot& robot, Laws& laws, Means means) {
  std::vector<Either> all;
  while (all.size() < most) {
    Either best = Vote(robot, laws, means).best();
    if (best.empty()) break;
    const bool done = best[0].kind == Mending::Kind::contradicting;
    if (!done) means = mended(means, best[0], laws);
    all.push_back(std::move(best));
    if (done) break;
  }
  return all;
}

}  // namespace sim::soundness
