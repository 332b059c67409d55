#include "components/logger/logger_node.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "components/node/type_schema.hpp"
#include "interfaces/recording/cdr.hpp"

namespace logger {
namespace {

// Messages that a reader keeps while the disk stalls. Chosen: 40 s of the fastest topic in real time,
// some seconds in lockstep, where messages are sent faster.
constexpr int queue_depth = 20'000;
constexpr std::int64_t take_period_ns = 2'000'000;
constexpr std::int64_t discover_period_ns = 250'000'000;
constexpr std::int64_t space_period_ns = 5'000'000'000;  // chosen: between checks of the free space
constexpr double min_space_s = 600;                      // chosen: recording time left
constexpr double min_space_bytes = 50e6;                 // chosen

std::string content(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::invalid_argument("attach: cannot read " + file);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

std::vector<recording::Attachment> attachments(const std::string& files) {
  std::vector<recording::Attachment> attachments;
  attachments.push_back(
      {.name = "git_revision.txt", .media_type = "text/plain", .data = ERP_REVISION});
  std::stringstream list(files);
  for (std::string file; std::getline(list, file, ':');)
    if (!file.empty())
      attachments.push_back({.name = file, .media_type = "application/xml", .data = content(file)});
  return attachments;
}

/// Moves an existing recording to the next free name (run.mcap becomes run.1.mcap). Returns `file`,
/// which is free then.
std::string rename_existing(const std::string& file) {
  namespace fs = std::filesystem;
  const fs::path path(file);
  if (!fs::exists(path)) return file;
  if (!fs::is_regular_file(path))
    throw std::invalid_argument("logger: " + file + " is not a regular file; give another name");
  for (int k = 1;; ++k) {
    auto new_path = path;
    new_path.replace_extension("." + std::to_string(k) + path.extension().string());
    if (fs::exists(new_path)) continue;
    fs::rename(path, new_path);
    spdlog::info("renamed the existing recording to {}", new_path.string());
    return file;
  }
}

}  // namespace

LoggerNode::LoggerNode(const Params& params, const erp::Robot& robot, node::Node& node)
    : node_(node),
      robot_(robot.name),
      recorder_(rename_existing(params.file), attachments(params.attach)),
      discovery_(node.participant(), node.wake()) {
  [this]<class... M>(std::type_identity<std::tuple<M...>>) {
    (add_known<M>(), ...);
  }(std::type_identity<erp::Messages>());
  node.every(take_period_ns, [this] { take_all(); });
  node.every(discover_period_ns, [this] { discover(); });
  node.on_deactivate([this] { close(); });
}

LoggerNode::~LoggerNode() {
  try {
    close();
  } catch (const std::exception& error) {
    node_.report(erp::Severity::fault, "", "recording", error.what());
  }
}

template <class M>
void LoggerNode::add_known() {
  if constexpr (!std::same_as<M, erp::LifecycleCommand>)  // not recorded
    add(erp::Topic<M>::name, *erp::Topic<M>::type, nullptr);
}

void LoggerNode::add(const std::string& name, const dds_topic_descriptor_t& type,
                     node::Descriptor descriptor) {
  Topic topic{0, node::describe(type), nullptr, std::move(descriptor)};
  topic.handle = recorder_.add_topic(
      name, {topic.type.name(), recording::ros2msg_text(topic.type), idl_text(topic.type.name())});
  // Only messages of this project begin with the name of the robot.
  topic.reader =
      std::make_unique<node::RawReader>(node_.participant(), node_.wake(), type, name, queue_depth,
                                        topic.descriptor ? std::string() : robot_);
  topics_.emplace(name, std::move(topic));
}

void LoggerNode::discover() {
  for (const auto& endpoint : discovery_.endpoints()) {
    if (!endpoint.writer || topics_.contains(endpoint.topic) ||
        unrecordable_.contains(endpoint.topic))
      continue;
    if (endpoint.topic == erp::Topic<erp::LifecycleCommand>::name) continue;
    const auto type = discovery_.type_of(endpoint.topic);
    if (!type) continue;
    try {
      add(endpoint.topic, *type, type);
    } catch (const std::invalid_argument& error) {
      unrecordable_[endpoint.topic] = 1;
      node_.report(erp::Severity::warning, "", "not_recorded", error.what());
    }
  }
}

void LoggerNode::take_all() {
  for (auto& [name, topic] : topics_)
    topic.reader->take([&](const node::RawSample& sample) { write(topic, sample); });
  recorder_.tick(node::monotonic_ns());
  report_disk();
  check_space();
  if (const auto missing = recorder_.missing(); missing > missing_reported_) {
    if (!missing_reported_)
      node_.report(
          erp::Severity::warning, "", "dropped",
          std::to_string(missing) + " messages are missing; erp log info counts them by topic");
    missing_reported_ = missing;
  }
}

/// A full disk ends neither the run nor the recording.
void LoggerNode::report_disk() {
  const bool fails = !recorder_.failure().empty();
  if (fails && !is_failing_)
    node_.report(erp::Severity::fault, "", "not_written",
                 recorder_.failure() + "; messages are lost until a write succeeds");
  if (!fails && is_failing_) {
    const auto& lost = recorder_.lost();
    node_.report(erp::Severity::warning, "", "written_again",
                 "the recording resumes; " + std::to_string(lost.count - lost_reported_) +
                     " messages are lost");
    lost_reported_ = lost.count;
  }
  is_failing_ = fails;
}

void LoggerNode::check_space() {
  const auto now_ns = node::monotonic_ns();
  if (is_space_reported_ || now_ns - space_checked_ns_ < space_period_ns) return;
  const double elapsed_s = 1e-9 * static_cast<double>(now_ns - space_checked_ns_);
  const double written = static_cast<double>(recorder_.bytes() - bytes_at_check_);
  const bool is_first = std::exchange(space_checked_ns_, now_ns) == 0;
  bytes_at_check_ = recorder_.bytes();
  std::error_code error;
  const auto folder = std::filesystem::absolute(recorder_.path()).parent_path();
  const auto space = std::filesystem::space(folder, error);
  if (error) return;
  const auto free_bytes = static_cast<double>(space.available);
  const bool is_short = !is_first && free_bytes < min_space_s * written / elapsed_s;
  if (!is_short && free_bytes > min_space_bytes) return;
  is_space_reported_ = true;
  char text[96];
  std::snprintf(text, sizeof text, "%.0f MB are free in ", 1e-6 * free_bytes);
  const std::string left =
      is_short
          ? ", enough for " + std::to_string(std::lround(free_bytes * elapsed_s / written)) + " s"
          : "";
  node_.report(erp::Severity::warning, "", "disk_space", text + folder.string() + left);
}

void LoggerNode::write(Topic& topic, const node::RawSample& raw) {
  const auto header = recording::header_of(topic.type, raw.cdr);
  if (!robot_.empty() && header.robot && *header.robot != robot_) return;
  char writer[20];
  const auto end = std::to_chars(writer, writer + sizeof writer, raw.writer, 16).ptr;
  recording::Sample sample;
  sample.writer = {writer, static_cast<std::size_t>(end - writer)};
  sample.publish_time_ns = static_cast<std::uint64_t>(header.stamp_ns.value_or(raw.source_ns));
  // In lockstep log times are simulated times. The clock follows the newest message, so they never
  // decrease.
  if (node_.clock().lockstep())
    node_.clock().advance(std::max(node_.clock().stamp_ns(), raw.source_ns));
  sample.log_time_ns = static_cast<std::uint64_t>(log_time_ns());
  sample.sequence = header.sequence;
  sample.cdr = raw.cdr;
  recorder_.write(topic.handle, sample);
  node_.count_step(raw.source_ns);
}

/// Wall time at the start of the recording plus the time since then on the monotonic clock.
std::int64_t LoggerNode::log_time_ns() const {
  if (node_.clock().lockstep()) return node_.clock().stamp_ns();
  return started_wall_ns_ + node::monotonic_ns() - started_ns_;
}

void LoggerNode::close() {
  if (closed_) return;
  closed_ = true;
  take_all();
  recorder_.close();
}

}  // namespace logger
