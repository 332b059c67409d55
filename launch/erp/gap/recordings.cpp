#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <ostream>
#include <stdexcept>

#include "launch/erp/gap/gap.hpp"
#include "sim/gap/checks/column_checks.hpp"
#include "sim/gap/checks/dead_columns.hpp"
#include "sim/gap/checks/table_checks.hpp"
#include "sim/gap/estimation/constants.hpp"
#include "sim/gap/estimation/defective_rows.hpp"
#include "sim/gap/estimation/limits.hpp"
#include "sim/gap/estimation/row_timing.hpp"
#include "sim/gap/residuals/common_signals.hpp"
#include "sim/gap/residuals/drives.hpp"
#include "sim/gap/residuals/stages.hpp"

namespace launch::gap {
namespace {

namespace residuals = sim::residuals;
namespace checks = sim::checks;

/// Collects messages about files. Lists each message once, with all files that it concerns.
class Messages {
 public:
  void add(const std::string& file, const std::vector<std::string>& of_file) {
    for (const std::string& message : of_file) {
      const std::string text = message.substr(file.size());  // each begins with the file name
      const auto existing = std::ranges::find(all_, text, &Message::text);
      if (existing == all_.end()) all_.push_back({file, text});
      else existing->files += ", " + file;
    }
  }
  std::vector<std::string> take() const {
    std::vector<std::string> lines;
    for (const Message& message : all_) lines.push_back(message.files + message.text);
    return lines;
  }

 private:
  struct Message {
    std::string files, text;
  };
  std::vector<Message> all_;
};

/// Hashes of the recordings read so far. Rejects copies, because data used for fitting cannot
/// validate the fit.
class Originals {
 public:
  /// Throws std::invalid_argument if another recording contains the same values.
  void add(const std::string& file, const recording::Table& table) {
    const std::uint64_t hash = hash_of(table);
    const auto existing = std::ranges::find(all_, hash, &Original::hash);
    if (existing != all_.end())
      throw std::invalid_argument(
          fmt::format("{}: holds the same values as {}; remove the copy", file, existing->file));
    all_.push_back({file, hash});
  }

 private:
  struct Original {
    std::string file;
    std::uint64_t hash;
  };
  /// FNV-1a hash of names and values.
  static std::uint64_t hash_of(const recording::Table& table) {
    constexpr std::uint64_t offset_basis = 14695981039346656037u, prime = 1099511628211u;  // FNV-1a
    std::uint64_t hash = offset_basis;
    const auto add = [&](std::uint64_t word) { hash = (hash ^ word) * prime; };
    for (const auto& column : table.columns) {
      for (const char c : column.name) add(std::uint64_t(c));
      for (const double x : column.values) add(std::bit_cast<std::uint64_t>(x));
    }
    return hash;
  }
  std::vector<Original> all_;
};

}  // namespace

erp::Robot read_chains(const std::string& robot_file) {
  erp::Robot robot = residuals::as_chains(erp::read_robot(robot_file));
  sim::estimation::constants_of(robot);  // throws if a tolerance matches no constant
  return robot;
}

Reading read_episodes(const erp::Robot& robot, const std::vector<std::string>& recordings) {
  Reading read;
  Messages suspicious;
  Originals originals;
  for (const std::string& file : recordings) {
    const auto table =
        recording::read_table(file, {.robot = robot.name, .sequences = true, .sent = true});
    originals.add(file, table);
    read.episodes.push_back(residuals::lay_out(table, robot, file, read.corrections));
    const residuals::Episode& episode = read.episodes.back();
    const double seconds = double(table.rows()) * episode.period_s;
    if (checks::nothing_changes(episode))
      throw std::invalid_argument(fmt::format(
          "{}: no signal changes: every signal of {} holds one value for {:.1f} s; record the "
          "robot while it moves",
          file, robot.name, seconds));
    if (residuals::windows_of(episode, {}).empty())
      read.corrections.push_back(
          fmt::format("{}: {:.2g} s are too short to evaluate any stage; the recording is ignored",
                      file, seconds));
    suspicious.add(file, checks::table_checks(table, robot, file));
    suspicious.add(file, checks::column_checks(episode, robot));
  }
  read.suspicious = suspicious.take();
  residuals::keep_common(read.episodes, robot, read.corrections);
  sim::estimation::repair_defective_rows(read.episodes, read.corrections);
  sim::estimation::compensate(sim::estimation::row_timing(read.episodes), read.episodes,
                              read.corrections);
  sim::estimation::apply_limits(robot, read.episodes, read.corrections);
  return read;
}

bool can_evaluate(const std::vector<residuals::Episode>& episodes) {
  return std::ranges::any_of(
      episodes, [](const residuals::Episode& e) { return !residuals::windows_of(e, {}).empty(); });
}

void print_lines(const std::vector<std::string>& messages, std::ostream& remarks) {
  for (const std::string& message : messages) remarks << message << "\n";
}

void print_suspicious(const Reading& read, std::ostream& remarks) {
  for (const std::string& fault : read.suspicious)
    remarks << "fix the recording first: " << fault << "\n";
}

}  // namespace launch::gap
