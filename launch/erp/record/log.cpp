#include "launch/erp/record/log.hpp"

#include <algorithm>
#include <map>
#include <ostream>

#include "interfaces/recording/csv.hpp"
#include "interfaces/recording/mcap_reader.hpp"
#include "interfaces/recording/topic_csv.hpp"
#include "launch/erp/record/plot.hpp"
#include "launch/erp/text/columns.hpp"
#include "launch/erp/verbs/guarded.hpp"

namespace launch {
namespace {

using recording::McapReader;

std::string bytes(std::size_t size) {
  if (size < 1000) return std::to_string(size) + " B";
  return size < 1000'000 ? decimal("%.1f kB", static_cast<double>(size) * 1e-3)
                         : decimal("%.1f MB", static_cast<double>(size) * 1e-6);
}

/// Sums over the channels of a topic; each writer and type has its own channel.
struct TopicRow {
  std::string type;
  std::uint64_t messages = 0, missing = 0, restarts = 0, writers = 0;
  std::uint64_t first_ns = UINT64_MAX, last_ns = 0;

  std::string rate() const {
    if (messages < 3 || last_ns <= first_ns) return "-";
    return decimal("%.1f Hz", static_cast<double>(messages - 1) * 1e9 /
                                  static_cast<double>(last_ns - first_ns));
  }
};

std::map<std::string, TopicRow> rows_of(const McapReader& reader) {
  std::map<std::string, TopicRow> rows;
  for (const auto& [id, channel] : reader.channels()) {
    TopicRow& row = rows[channel.topic];
    ++row.writers;
    const auto schema = reader.schemas().find(channel.schema_id);
    row.type = schema == reader.schemas().end() ? "(no schema)" : schema->second.name;
    const auto statistics = reader.statistics().find(id);
    if (statistics == reader.statistics().end()) continue;
    row.messages += statistics->second.messages;
    row.missing += statistics->second.missing;
    row.restarts += statistics->second.restarts;
    row.first_ns = std::min(row.first_ns, statistics->second.first_ns);
    row.last_ns = std::max(row.last_ns, statistics->second.last_ns);
  }
  return rows;
}

/// Longest duration of a topic. Topics are not compared, because their stamps may come from
/// different clocks.
double duration_s(const std::map<std::string, TopicRow>& rows) {
  std::uint64_t longest_ns = 0;
  for (const auto& [topic, row] : rows)
    if (row.last_ns > row.first_ns) longest_ns = std::max(longest_ns, row.last_ns - row.first_ns);
  return static_cast<double>(longest_ns) * 1e-9;
}

void print_head(const McapReader& reader, std::ostream& out) {
  out << reader.path() << ": " << (reader.complete() ? "complete" : "cut off") << ", "
      << decimal("%.3f s, ", duration_s(rows_of(reader))) << reader.contents().messages
      << " messages in " << reader.contents().chunks << " chunks, by " << reader.contents().library
      << '\n';
  if (!reader.complete())
    out << "  " << reader.truncation() << "; recover the readable messages with: erp log recover "
        << reader.path() << '\n';
}

/// Messages that the logger could not write, from the metadata that it leaves.
void print_lost(const McapReader& reader, std::ostream& out) {
  for (const auto& metadata : reader.contents().metadata) {
    if (metadata.name != "lost_messages") continue;
    const auto value = [&](const char* name) {
      const auto found = metadata.values.find(name);
      return found == metadata.values.end() ? 0.0 : std::strtod(found->second.c_str(), nullptr);
    };
    out << "  " << static_cast<std::uint64_t>(value("count")) << " messages within "
        << decimal("%.1f s", 1e-9 * (value("last_log_time_ns") - value("first_log_time_ns")))
        << " could not be written to the disk\n";
  }
}

/// Steps of the clock that stamped the frames.
void print_clock_steps(const McapReader& reader, std::ostream& out) {
  for (const auto& [id, channel] : reader.channels()) {
    const auto statistics = reader.statistics().find(id);
    if (channel.topic != "ecu_frame" || statistics == reader.statistics().end()) continue;
    const recording::ChannelStatistics& frames = statistics->second;
    for (const auto& step : frames.times.steps())
      out << "  " << recording::text_of(step, frames.first_stamp_ns)
          << "; log times and exported times do not contain this step\n";
  }
}

void print_topics(const McapReader& reader, std::ostream& out) {
  std::vector<std::vector<std::string>> cells{
      {"topic", "type", "messages", "rate", "missing", "restarts", "writers"}};
  for (const auto& [topic, row] : rows_of(reader))
    cells.push_back({topic, row.type, std::to_string(row.messages), row.rate(),
                     std::to_string(row.missing), std::to_string(row.restarts),
                     std::to_string(row.writers)});
  for (const auto& line : align(cells, {false, false, true, true, true, true, true}))
    out << line << '\n';
}

void print_attachments(const McapReader& reader, std::ostream& out) {
  if (reader.attachments().empty()) return;
  std::vector<std::vector<std::string>> cells{{"attachment", "media type", "size"}};
  for (const auto& attachment : reader.attachments())
    cells.push_back({attachment.name, attachment.media_type, bytes(attachment.data.size())});
  out << '\n';
  for (const auto& line : align(cells, {false, false, true})) out << line << '\n';
}

}  // namespace

int log_info(const std::string& path, std::ostream& out) {
  return guarded([&] {
    const McapReader reader(path);
    print_head(reader, out);
    print_lost(reader, out);
    print_clock_steps(reader, out);
    out << '\n';
    print_topics(reader, out);
    print_attachments(reader, out);
    return flush_or_throw(out);
  });
}

int log_export(const std::string& path, std::ostream& out, const LogExportOptions& options) {
  return guarded([&] {
    if (options.topic.empty())
      recording::write_csv(recording::read_table(path, {.robot = options.robot}), out);
    else recording::write_topic_csv(McapReader(path), options.topic, out);
    return flush_or_throw(out);
  });
}

int log_recover(const std::string& in, const std::string& out, std::ostream& report) {
  return guarded([&] {
    const auto recovered = recording::recover(in, out);
    for (const std::string& problem : recovered.problems) report << problem << '\n';
    report << out << ": " << recovered.messages << " messages and " << recovered.attachments
           << " attachments\n";
    return recovered.messages + recovered.attachments > 0 ? 0 : 1;
  });
}

int log_plot(const std::string& path, const std::string& out, const LogPlotOptions& options) {
  return guarded([&] {
    const auto table =
        recording::read_table(path, {.robot = options.robot, .lines = true, .targets = true});
    const std::string title =
        options.title.empty() ? path.substr(path.rfind('/') + 1) : options.title;
    draw(plot_script(table, options.signals, title, path), out);
    return 0;
  });
}

}  // namespace launch
