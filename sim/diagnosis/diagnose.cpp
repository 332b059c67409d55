#include "sim/diagnosis/diagnose.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "sim/diagnosis/lattice.hpp"

namespace sim::diagnosis {
namespace {

using effects::Placed;

Named named(const Placed& placed) {
  const effects::About& about = effects::about(placed.effect);
  Named n{std::string(about.type), placed.on, about.stage, {}, {}, {}, 0, {}, false, placed};
  effects::AnyEffect copy = placed.effect;
  for (const effects::Parameter& p : effects::parameters(copy))
    if (p.fitted) n.names.emplace_back(p.name), n.values.push_back(*p.value);
  n.intervals.resize(n.values.size());
  return n;
}

Named named(const Ranked& ranked, const DiagnoseOptions& options) {
  constexpr double of_method = 0.02;  // what the windows' own approximations may shift a value by
  Named n = named(ranked.fit.placed);
  for (std::size_t k = 0; k < n.values.size(); ++k) {
    const double half = 1.96 * ranked.fit.sigmas[k] + of_method * std::abs(n.values[k]);
    n.intervals[k] = {n.values[k] - half, n.values[k] + half};
  }
  n.gain = ranked.gain, n.gain_interval = ranked.gain_interval;
  n.supported = ranked.gain_interval.low > options.least_gain;
  return n;
}

/// Benjamini and Hochberg 1995, at 5 %: what is left of `supported`.
void control_discoveries(const std::vector<Ranked>& ranked, std::vector<Named>& names) {
  std::vector<std::pair<double, std::size_t>> doubts;
  for (std::size_t k = 0; k < ranked.size(); ++k) doubts.emplace_back(ranked[k].doubt, k);
  std::ranges::sort(doubts);
  std::size_t kept = 0;
  for (std::size_t k = 0; k < doubts.size(); ++k)
    if (doubts[k].first <= 0.05 * static_cast<double>(k + 1) / static_cast<double>(doubts.size()))
      kept = k + 1;
  for (std::size_t k = kept; k < doubts.size(); ++k) names[doubts[k].second].supported = false;
}

/// One diagnosis on its way.
class Course {
 public:
  Course(const erp::Robot& robot, std::vector<Episode> episodes, const DiagnoseOptions& options)
      : robot_(robot), episodes_(std::move(episodes)), options_(options) {
    if (episodes_.empty()) throw std::invalid_argument("no recording");
    chosen_split_ = options_.train.empty() && options_.held_out.empty();
    if (chosen_split_) std::tie(options_.train, options_.held_out) = split(episodes_);
    if (options_.held_out.empty()) {
      options_.held_out = options_.train;
      result_.warnings.emplace_back(
          "one recording only: effects are chosen and judged on the same data; record another");
    }
    for (const Episode& e : episodes_) result_.recordings.push_back(e.name);
  }

  Diagnosis run() {
    tell("residuals", 0.05);
    const Trials plain(robot_, episodes_, options_.seed);
    std::vector<std::size_t> all(episodes_.size());
    std::iota(all.begin(), all.end(), 0);
    result_.stages = where(plain, plain.bare(), all, where_options());
    if (chosen_split_) hold_out_what_shows(plain);
    for (const std::size_t k : options_.train) result_.train.push_back(episodes_[k].name);
    for (const std::size_t k : options_.held_out) result_.held_out.push_back(episodes_[k].name);
    look_at_bus();
    erp::Robot known = robot_;  // with what was seen without a fit
    look_at_lattices(plain, known);
    if (known.effects.size() > robot_.effects.size()) {
      const Trials coarse(known, episodes_, options_.seed);
      search(coarse);
    } else {
      search(plain);
    }
    close(plain);
    return std::move(result_);
  }

 private:
  void tell(const std::string& what, double share) const {
    if (options_.progress) options_.progress(what, share);
  }
  WhereOptions where_options() const { return {.seed = options_.seed}; }

  /// A recording held out that does not show the gap cannot judge: then the one that shows it
  /// second best is held out, if there are two.
  void hold_out_what_shows(const Trials& plain) {
    std::vector<std::pair<double, std::size_t>> shows;
    for (const std::size_t e : all()) {
      const std::size_t only[] = {e};
      double most = 0;
      for (const StageGap& gap : where(plain, plain.bare(), only, where_options()))
        if (gap.open) most = std::max(most, gap.excess);
      if (most > 0) shows.emplace_back(most, e);
    }
    const bool shown = std::ranges::any_of(
        shows, [&](const auto& s) { return std::ranges::count(options_.held_out, s.second); });
    if (shown || shows.size() < 2) return;
    std::ranges::sort(shows);
    options_.held_out = {shows[shows.size() - 2].second};  // the very best is to learn from
    options_.train.clear();
    for (const std::size_t e : all())
      if (e != options_.held_out[0]) options_.train.push_back(e);
  }

  void look_at_bus() {
    std::vector<Ages> train, held_out;
    for (const std::size_t e : options_.train) train.push_back(command_ages(episodes_[e], robot_));
    for (const std::size_t e : options_.held_out)
      held_out.push_back(command_ages(episodes_[e], robot_));
    const auto fits = fit_bus(train, held_out, robot_, options_.withhold);
    late_ = late_share(held_out);
    for (const BusFit& fit : fits) {
      Named n = named(fit.placed);
      n.intervals[0] = {fit.low, fit.high};
      n.gain = fit.gain, n.gain_interval = {fit.gain, fit.gain}, n.supported = fit.supported;
      bus_.push_back(n);
    }
  }

  void look_at_lattices(const Trials& plain, erp::Robot& known) {
    for (const Placed& placed : coarse_sensors(episodes_, robot_)) {
      if (std::ranges::count(options_.withhold, effects::about(placed.effect).type)) continue;
      erp::Robot coarse = robot_;
      coarse.effects.push_back(effects::written(placed));
      const Trials trials(coarse, episodes_, options_.seed);
      const auto before = sum(plain.blocks(plain.bare(), options_.held_out));
      double after = 0;  // what is left beyond the noise of the coarser sensor, in the old units
      for (const std::size_t e : options_.held_out) {
        const auto old = plain.whitened(plain.bare(), e), now = trials.whitened(trials.bare(), e);
        for (std::size_t k = 0; k < old.size(); ++k)
          if (!std::isnan(old[k]) && !std::isnan(now[k]))
            after += now[k] == 0 ? 1 : 1 + (now[k] * now[k] - 1);
      }
      const double windows = static_cast<double>(before.windows);
      Named n = named(placed);
      const double spread = 0.05 * n.values[0];
      n.intervals[0] = {n.values[0] - spread, n.values[0] + spread};
      n.gain = (before.square - std::max(after, windows)) / std::max(before.square - windows, 1e-9);
      n.gain_interval = {n.gain, n.gain};
      n.supported = true;  // the readings show it
      known.effects.push_back(effects::written(placed));
      lattices_.push_back(n);
    }
  }

  /// The stages that are still open on the held-out recordings.
  std::vector<StageGap> open(const Trials& trials, const Trial& trial, bool generous) const {
    auto gaps = where(trials, trial, options_.held_out, where_options());
    const auto before = where(trials, trials.bare(), options_.held_out, where_options());
    double most = 0;
    for (const StageGap& b : before) most = std::max(most, b.excess);
    for (StageGap& gap : gaps) {
      const auto was = std::ranges::find_if(
          before, [&](const StageGap& b) { return b.stage == gap.stage && b.on == gap.on; });
      const double share = generous ? options_.single_left_share : options_.left_share;
      const double least = generous ? options_.left_excess : options_.search_excess;
      const double of_most = generous ? options_.single_left_of_most * most : 0;
      gap.open = gap.open && gap.excess > std::max({least, share * was->excess, of_most});
    }
    return gaps;
  }
  static bool any_open(const std::vector<StageGap>& gaps) {
    return std::ranges::any_of(gaps, &StageGap::open);
  }

  WhichOptions which_options(double from, double to) const {
    WhichOptions which{.train = options_.train,
                       .held_out = options_.held_out,
                       .withhold = options_.withhold,
                       .threads = options_.threads,
                       .seed = options_.seed};
    which.progress = [this, from, to](std::size_t done, std::size_t of) {
      tell("effects", from + (to - from) * static_cast<double>(done) / static_cast<double>(of));
    };
    return which;
  }

  void search(const Trials& trials) {
    const auto all_gaps = where(trials, trials.bare(), all(), where_options());
    gap_ = any_open(all_gaps);
    if (!gap_) return;
    first_ = rank(trials, trials.bare(), which_options(0.1, 0.5));
    if (first_.empty()) return;
    for (const Ranked& r : first_) result_.ranked.push_back(named(r, options_));
    sign(trials);
    control_discoveries(first_, result_.ranked);
    before_ = trials.blocks(trials.bare(), options_.held_out);
    if (!result_.ranked[0].supported) return;
    chosen_ = {first_[0].fit.placed};
    result_.answer = {result_.ranked[0]};
    trial_ = trials.with(trials.bare(), chosen_[0], all());
    while (any_open(open(trials, trial_, false)) && chosen_.size() < options_.most_effects)
      if (!add_another(trials)) break;
    if (chosen_.size() > 1) settle(trials);
    result_.left = open(trials, trial_, chosen_.size() == 1);
    open_after_ = any_open(result_.left);
    for (const std::size_t k : confusable(first_, before_, which_options(0, 0)))
      if (chosen_.size() == 1) result_.confusable.push_back(result_.ranked[k]);
  }

  /// What each candidate changes, by stage, and how like the first's change it is.
  void sign(const Trials& trials) {
    std::vector<double> first;
    for (std::size_t k = 0; k < first_.size(); ++k) {
      std::vector<double> change, square(result_.stages.size(), 0.0);
      double whole = 0;
      for (const std::size_t e : options_.held_out) {
        const auto before = trials.whitened(trials.bare(), e);
        const auto after = trials.whitened(first_[k].on_held_out, e);
        std::size_t at = 0;
        for (const Residual& r : trials.bare().of_episode[e].residuals) {
          const auto stage = std::ranges::find_if(result_.stages, [&](const StageGap& gap) {
            return gap.stage == r.stage && gap.on == r.on;
          });
          for (std::size_t n = 0; n < r.value.size(); ++n, ++at) {
            const double d = std::isnan(before[at]) ? 0 : after[at] - before[at];
            change.push_back(d), whole += d * d;
            square[std::size_t(stage - result_.stages.begin())] += d * d;
          }
        }
      }
      for (double& s : square) s /= std::max(whole, 1e-12);
      if (k == 0) first = change;
      double dot = 0, size = 0;
      for (std::size_t n = 0; n < first.size(); ++n)
        dot += first[n] * change[n], size += first[n] * first[n];
      result_.ranked[k].signature = square;
      result_.ranked[k].likeness = dot / std::max(std::sqrt(size * whole), 1e-12);
      first_[k].on_held_out = {};  // large, and no longer needed
    }
  }

  /// The worst second of each stage that is open, in a held-out recording, with two around it.
  void look_closely(const Trials& plain) {
    constexpr std::size_t most = 3;
    for (const StageGap& gap : result_.stages) {
      if (!gap.open || result_.worst.size() == most) continue;
      Moment worst{gap.stage, gap.on, gap.unit, "", 0, {}, {}, {}};
      double largest = -1;
      for (const std::size_t e : options_.held_out) look_closely(plain, gap, e, largest, worst);
      result_.worst.push_back(std::move(worst));
    }
  }
  void look_closely(const Trials& plain, const StageGap& gap, std::size_t e, double& largest,
                    Moment& worst) const {
    const auto& residuals = plain.bare().of_episode[e].residuals;
    const auto at = std::ranges::find_if(
        residuals, [&](const Residual& r) { return r.stage == gap.stage && r.on == gap.on; });
    if (at == residuals.end()) return;
    const auto r = static_cast<std::size_t>(at - residuals.begin());
    const auto size = [&](std::size_t k) { return std::abs(at->value[k]); };
    std::size_t peak = 0;
    for (std::size_t k = 0; k < at->value.size(); ++k)
      if (!std::isnan(at->value[k]) && (std::isnan(at->value[peak]) || size(k) > size(peak)))
        peak = k;
    if (std::isnan(at->value[peak]) || size(peak) <= largest) return;
    largest = size(peak);
    worst.recording = episodes_[e].name, worst.floor = plain.floor(e)[r];
    worst.time_s.clear(), worst.before.clear(), worst.after.clear();
    constexpr std::size_t around = 125;  // windows: 2.5 s
    const auto& left = trial_.of_episode.empty() ? residuals : trial_.of_episode[e].residuals;
    for (std::size_t k = peak < around ? 0 : peak - around;
         k < std::min(at->value.size(), peak + around); ++k) {
      worst.time_s.push_back(double(plain.bare().of_episode[e].rows[k]) * episodes_[e].period_s);
      worst.before.push_back(at->value[k]), worst.after.push_back(left[r].value[k]);
    }
  }

  /// It takes away half of what the others leave at a stage that is open.
  bool helps(const Trials& trials, const Placed& more) const {
    constexpr double worth = 0.5;  // chosen
    const auto before = open(trials, trial_, false);
    const auto after = where(trials, trials.with(trial_, more, options_.held_out),
                             options_.held_out, where_options());
    return std::ranges::any_of(before, [&](const StageGap& b) {
      const auto a = std::ranges::find_if(
          after, [&](const StageGap& g) { return g.stage == b.stage && g.on == b.on; });
      return b.open && a->excess < (1 - worth) * b.excess;
    });
  }

  /// The best effect on top of the others, if it helps.
  bool add_another(const Trials& trials) {
    const double share = 0.5 + 0.15 * static_cast<double>(chosen_.size() - 1);
    const auto more = rank(trials, trial_, which_options(share, share + 0.1));
    if (more.empty() || more[0].gain_interval.low < options_.least_gain ||
        !helps(trials, more[0].fit.placed))
      return false;
    chosen_.push_back(more[0].fit.placed);
    refit(trials);
    // was an earlier choice a compromise between two?
    for (std::size_t k = 0; k + 1 < chosen_.size(); ++k) {
      std::vector<Placed> others = chosen_;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
      const Trial without = trials.with(others, all());
      const auto again = rank(trials, without, which_options(share + 0.1, share + 0.15));
      if (again.empty() || (again[0].fit.placed.on == chosen_[k].on &&
                            again[0].fit.placed.effect.index() == chosen_[k].effect.index()))
        continue;
      others.push_back(again[0].fit.placed);
      const auto kept = chosen_;
      const double was = sum(trials.blocks(trial_, options_.held_out)).square;
      chosen_ = others;
      refit(trials);
      if (sum(trials.blocks(trial_, options_.held_out)).square > was) {
        chosen_ = kept;
        refit(trials);
      }
    }
    return true;
  }

  void refit(const Trials& trials) {
    fits_ = fit_together(trials, chosen_, options_.train);
    for (std::size_t k = 0; k < chosen_.size(); ++k) chosen_[k] = fits_[k].placed;
    trial_ = trials.with(chosen_, all());
  }

  /// What could stand for one of several effects as well.
  void add_alternatives(const Trials& trials, const Trial& without, const Placed& chosen) {
    const auto ranked = rank(trials, without, which_options(0.85, 0.95));
    if (ranked.empty() || ranked[0].fit.placed.on != chosen.on) return;
    auto same = confusable(ranked, trials.blocks(without, options_.held_out), which_options(0, 0));
    same.push_back(0);
    for (const std::size_t k : same)
      if (ranked[k].fit.placed.effect.index() != chosen.effect.index() ||
          ranked[k].fit.placed.on != chosen.on)
        result_.confusable.push_back(named(ranked[k], options_));
  }

  /// Of several effects: each one's gain is what is lost without it. The most telling first.
  void settle(const Trials& trials) {
    result_.answer.clear();
    const auto whole = sum(before_);
    const double gap = whole.square - static_cast<double>(whole.windows);
    const double with_all = sum(trials.blocks(trial_, options_.held_out)).square;
    for (std::size_t k = 0; k < chosen_.size(); ++k) {
      std::vector<Placed> others = chosen_;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(k));
      const Trial without = trials.with(others, all());
      add_alternatives(trials, without, fits_[k].placed);
      const auto blocks = trials.blocks(without, options_.held_out);
      const auto with = trials.blocks(trial_, options_.held_out);
      Ranked r{fits_[k], {}, {}, (sum(blocks).square - with_all) / gap, {}, 0};
      r.gain_interval = middle(
          bootstrap(blocks.size(), 400, options_.seed, [&](const std::vector<std::size_t>& drawn) {
            double lost = 0, was = 0;
            for (const std::size_t b : drawn)
              lost += blocks[b].square - with[b].square,
                  was += before_[b].square - static_cast<double>(before_[b].windows);
            return lost / std::max(was, 1e-9);
          }));
      Named n = named(r, options_);
      n.supported = r.gain_interval.low > 0;
      result_.answer.push_back(n);
    }
    std::ranges::stable_sort(result_.answer, std::greater(), &Named::gain);
  }

  void close(const Trials& plain) {
    judge();
    result_.answer.insert(result_.answer.begin(), lattices_.begin(), lattices_.end());
    if (!bus_.empty()) add_bus();
    result_.ranked.insert(result_.ranked.begin(), lattices_.begin(), lattices_.end());
    for (const StageGap& gap : where(plain, plain.bare(), options_.held_out, where_options())) {
      Closed c{std::string(effects::word(gap.stage)) + " " + gap.on,
               gap.unit,
               gap.rms,
               gap.floor,
               gap.rms,
               0,
               {}};
      const auto left = std::ranges::find_if(
          result_.left, [&](const StageGap& l) { return l.stage == gap.stage && l.on == gap.on; });
      if (left != result_.left.end()) c.after = left->rms;
      c.closed = closed_of(c);
      result_.channels.push_back(c);
    }
    sum_up(plain);
    locate(plain);
    look_closely(plain);
    tell("done", 1);
  }

  static double closed_of(const Closed& c) {
    return c.before > c.floor ? (c.before - c.after) / (c.before - c.floor) : 0;
  }

  /// Over all stages, in units of noise.
  void sum_up(const Trials& plain) {
    const auto before = plain.blocks(plain.bare(), options_.held_out);
    const auto after = trial_.of_episode.empty() ? before : plain.blocks(trial_, options_.held_out);
    const auto of = [&](const std::vector<std::size_t>& drawn) {
      Closed c{"all", "noise", 0, 1, 0, 0, {}};
      double was = 0, is = 0, n = 0;
      for (const std::size_t b : drawn)
        was += before[b].square, is += after[b].square, n += double(before[b].windows);
      c.before = std::sqrt(was / std::max(n, 1.0)), c.after = std::sqrt(is / std::max(n, 1.0));
      c.closed = closed_of(c);
      return c;
    };
    std::vector<std::size_t> every(before.size());
    std::iota(every.begin(), every.end(), 0);
    result_.overall = of(every);
    result_.overall.interval =
        middle(bootstrap(before.size(), 400, options_.seed,
                         [&](const std::vector<std::size_t>& drawn) { return of(drawn).closed; }));
  }

  /// The effects of the answer say where; without them the open stages do, and the stage of the
  /// effect that comes nearest says of which of several causes of one residual it looks.
  void locate(const Trials& plain) {
    const bool known = result_.verdict == Verdict::supported;
    double whole = 0;
    for (const Named& n : result_.answer) whole += std::max(0.0, n.gain);
    for (const Named& n : result_.answer) {
      if (!known) break;
      Located place{n.stage, n.on, whole > 0 ? n.gain / whole : 1, n.gain_interval, {}};
      place.when = when(plain, n.on);
      result_.where.push_back(place);
    }
    if (known) add_confusable();
    for (const StageGap& gap : result_.stages) {
      if (!gap.open || known) continue;
      Located place{gap.stage, gap.on, gap.share, gap.excess_interval, when(plain, gap.on)};
      if (result_.where.empty() && !result_.ranked.empty()) {
        constexpr double near = 0.3;  // of the gap; chosen
        const Named& nearest = result_.ranked[0];
        if (nearest.gain > near) place.stage = nearest.stage, place.on = nearest.on;
        if (nearest.gain > near) {
          result_.where.push_back(place);
          add_nearly_as_near(nearest);
          continue;
        }
      }
      const bool same = std::ranges::any_of(result_.where, [&](const Located& other) {
        return other.stage == place.stage && other.on == place.on;
      });
      if (!same) result_.where.push_back(place);
    }
    for (const StageGap& gap : result_.left)
      if (gap.open)
        result_.unexplained.push_back(
            {gap.stage, gap.on, gap.excess,
             shape_of(plain, trial_, gap.stage, gap.on, options_.train, options_.held_out)});
  }

  /// Where no effect explains the gap, the stages of all that come about as near share it.
  void add_nearly_as_near(const Named& nearest) {
    constexpr double about_as_near = 0.6;  // of the nearest's gain; chosen
    for (const Named& n : result_.ranked)
      if (n.on == nearest.on && n.gain > about_as_near * nearest.gain &&
          std::ranges::none_of(result_.where,
                               [&](const Located& other) { return other.stage == n.stage; }))
        result_.where.push_back({n.stage, n.on, 0, {}, result_.where[0].when});
    const double share = result_.where[0].share / static_cast<double>(result_.where.size());
    for (Located& place : result_.where) place.share = share;
  }

  /// What cannot be told apart shares its part of the gap.
  void add_confusable() {
    std::vector<Located> group{result_.where[0]};
    for (const Named& n : result_.confusable)
      if (std::ranges::none_of(group, [&](const Located& other) {
            return other.stage == n.stage && other.on == n.on;
          }))
        group.push_back({n.stage, n.on, 0, result_.where[0].interval, result_.where[0].when});
    const double share = result_.where[0].share / static_cast<double>(group.size());
    for (Located& place : group) place.share = share;
    result_.where.erase(result_.where.begin());
    result_.where.insert(result_.where.begin(), group.begin(), group.end());
  }

  /// When the residual of what sits there lives, at its most open stage.
  std::vector<Region> when(const Trials& plain, const std::string& on) const {
    const auto most = std::ranges::find_if(
        result_.stages, [&](const StageGap& gap) { return gap.open && gap.on == on; });
    if (most == result_.stages.end()) return {};
    return regions(plain, plain.bare(), most->stage, on, all());
  }

  void judge() {
    const bool seen = !lattices_.empty() || (!bus_.empty() && bus_[0].supported);
    if (!gap_) {
      result_.verdict = seen           ? Verdict::supported
                        : late_ > 0.02 ? Verdict::none_of_the_known
                                       : Verdict::no_gap;
      return;
    }
    if (chosen_.empty() || open_after_) result_.verdict = Verdict::none_of_the_known;
    else result_.verdict = Verdict::supported;
  }

  void add_bus() {
    result_.ranked.insert(result_.ranked.begin(), bus_.begin(), bus_.end());
    if (!bus_[0].supported) return;
    const bool alone = result_.answer.empty();
    result_.answer.insert(alone ? result_.answer.begin() : result_.answer.end(), bus_[0]);
    if (!alone) return;
    for (std::size_t k = 1; k < bus_.size(); ++k)
      if (bus_[0].gain - bus_[k].gain < 0.01) result_.confusable.push_back(bus_[k]);
  }

  std::vector<std::size_t> all() const {
    std::vector<std::size_t> all(episodes_.size());
    std::iota(all.begin(), all.end(), 0);
    return all;
  }

  const erp::Robot& robot_;
  std::vector<Episode> episodes_;
  DiagnoseOptions options_;
  Diagnosis result_;
  std::vector<Named> bus_, lattices_;
  std::vector<Ranked> first_;
  std::vector<ScoreBlock> before_;
  std::vector<Placed> chosen_;
  std::vector<Fit> fits_;
  Trial trial_;
  bool chosen_split_ = false, gap_ = false, open_after_ = false;
  double late_ = 0;
};

}  // namespace

const char* word(Verdict verdict) {
  constexpr const char* words[] = {"no_gap", "supported", "none_of_the_known", "not_identifiable"};
  return words[static_cast<std::size_t>(verdict)];
}

Diagnosis diagnose(const erp::Robot& robot, std::vector<Episode> episodes,
                   const DiagnoseOptions& options) {
  return Course(robot, std::move(episodes), options).run();
}

}  // namespace sim::diagnosis
