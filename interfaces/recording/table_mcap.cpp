#include <algorithm>
#include <map>
#include <numeric>
#include <optional>
#include <set>

#include "interfaces/recording/column_group.hpp"
#include "interfaces/recording/fields.hpp"
#include "interfaces/recording/frame_times.hpp"
#include "interfaces/recording/mcap_reader.hpp"
#include "interfaces/recording/ros2msg.hpp"
#include "interfaces/recording/table.hpp"
#include "interfaces/values.hpp"

namespace recording {
namespace {

/// A signal of the table, its field in a sample, and its bit in `valid`.
struct Source {
  const char* signal;
  const char* field;
  unsigned valid;  ///< 0: no valid bit
};
constexpr Source actuator_sources[] = {{"mode", "mode", 0},
                                       {"reference", "reference", 0},
                                       {"voltage_V", "voltage_V", erp::valid::voltage},
                                       {"current_A", "current_A", erp::valid::current},
                                       {"shaft_rad", "shaft_rad", erp::valid::shaft},
                                       {"tension_N", "tension_N", erp::valid::tension}};
constexpr Source potentiometer_source{"potentiometer_rad", "potentiometer_rad",
                                      erp::valid::potentiometer};
constexpr Source line_source{"line_m", "line_m", erp::valid::line};
constexpr Source joint_source{"angle_rad", "angle_rad", erp::valid::joint_angle};

struct Row {
  std::int64_t at_ns;  ///< its stamp, without steps of the clock
  std::uint64_t sequence, log_time_ns;
};

struct Target {
  std::string actuator;
  double mode, reference;
  std::uint64_t answers, log_time_ns;
};

/// A set-point of one ECU channel in its counts. The plant sent it, or the ECU reports that it
/// followed it.
struct SetPoint {
  std::string channel;
  double request, counts;
  std::uint64_t sequence;  ///< sent: of the answered frame; followed: of the reporting frame
};

struct Pose {
  std::int64_t at_ns;
  double q[4];
};

class Builder {
 public:
  Builder(const McapReader& recording, const TableOptions& options)
      : recording_(recording), options_(options) {
    for (const auto& [id, channel] : recording.channels()) {
      const auto schema = recording.schemas().find(channel.schema_id);
      if (schema == recording.schemas().end() || schema->second.encoding != "ros2msg") continue;
      if (!is_needed(channel.topic) || types_.contains(channel.schema_id)) continue;
      types_[channel.schema_id] = parse_ros2msg(schema->second.name, schema->second.data);
    }
  }

  Table run() {
    recording_.for_each([&](const Message& message) { take(message); }, Order::file);
    if (rows_.empty())
      throw RecordingError(recording_.path() + ": contains no sensor_frame" +
                           (options_.robot.empty() ? "" : " of robot \"" + options_.robot + "\"") +
                           "; list its contents with: erp log info " + recording_.path());
    join_targets();
    join_set_points();
    join_poses();
    return assemble();
  }

 private:
  bool is_needed(const std::string& topic) const {
    return topic == "sensor_frame" || topic == "joint_state" ||
           (options_.targets && topic == "actuator_target") ||
           (options_.sent && (topic == "ecu_command" || topic == "ecu_frame"));
  }

  void take(const Message& message) {
    const std::string& topic = message.channel.topic;
    const auto type = types_.find(message.channel.schema_id);
    if (type == types_.end() || !is_needed(topic)) return;
    const Members members = decode_cdr(type->second, message.data);
    if (!is_of_robot(text_in(members, "robot"), topic)) return;
    if (topic == "sensor_frame") take_frame(members, message.log_time_ns);
    else if (topic == "joint_state") take_joints(members);
    else if (topic == "ecu_command") take_set_points(members, "answers", sent_);
    else if (topic == "ecu_frame") take_set_points(members, "sequence", followed_);
    else take_targets(members, message.log_time_ns);
  }

  bool is_of_robot(const std::string& robot, const std::string& topic) {
    if (!options_.robot.empty()) return robot == options_.robot;
    if (topic == "sensor_frame") robots_.insert(robot);
    if (robots_.size() > 1)
      throw RecordingError(recording_.path() + ": contains the robots " + *robots_.begin() +
                           " and " + *robots_.rbegin() + "; give the name of one");
    return robots_.empty() || robots_.contains(robot);
  }

  void take_frame(const Members& frame, std::uint64_t log_time_ns) {
    const std::size_t row = rows_.size();
    const auto sequence = integer_in<std::uint64_t>(frame, "sequence");
    const auto stamp_ns = integer_in<std::int64_t>(frame, "stamp_ns");
    rows_.push_back({times_.add(stamp_ns, sequence, log_time_ns), sequence, log_time_ns});
    each_in(frame, "actuators", [&](const Members& sample) {
      const std::string name = text_in(sample, "name");
      const auto valid = flags_in(sample, "valid");
      const bool is_driven = number_in(sample, "mode") != 0;
      for (const Source& source : actuator_sources)
        set(actuators_, name, source, row, sample, source.valid ? valid & source.valid : is_driven);
      if (valid & potentiometer_source.valid)
        set(actuators_, name, potentiometer_source, row, sample, true);
      if (options_.lines)
        set(actuators_, name, line_source, row, sample, valid & line_source.valid);
    });
    each_in(frame, "joints", [&](const Members& sample) {
      const auto valid = flags_in(sample, "valid");
      set(joints_, text_in(sample, "name"), joint_source, row, sample, valid & joint_source.valid);
    });
  }

  static void set(ColumnGroup& group, const std::string& owner, const Source& source,
                  std::size_t row, const Members& sample, bool taken) {
    group.set(owner, source.signal, row, taken ? number_in(sample, source.field) : not_taken);
  }

  void take_targets(const Members& command, std::uint64_t log_time_ns) {
    const auto answers = integer_in<std::uint64_t>(command, "answers");
    each_in(command, "actuators", [&](const Members& sample) {
      targets_.push_back({text_in(sample, "name"), number_in(sample, "mode"),
                          number_in(sample, "reference"), answers, log_time_ns});
    });
  }

  static void take_set_points(const Members& message, const char* sequence_field,
                              std::vector<SetPoint>& all) {
    each_in(message, "channels", [&](const Members& sample) {
      all.push_back({channel_name(int(number_in(sample, "ecu")), int(number_in(sample, "channel"))),
                     number_in(sample, "request"), number_in(sample, "setpoint"),
                     integer_in<std::uint64_t>(message, sequence_field)});
    });
  }

  void take_joints(const Members& state) {
    const std::string source = text_in(state, "source");
    each_in(state, "joints", [&](const Members& sample) {
      const Value* position = sample.find("position");
      if (number_in(sample, "dof") != 3 || !position || !position->elements() ||
          position->elements()->size() != 4)
        return;
      Pose pose{times_.steady_ns(integer_in<std::int64_t>(state, "stamp_ns")), {}};
      for (std::size_t i = 0; i < 4; ++i)
        pose.q[i] = (*position->elements())[i].number().value_or(not_taken);
      poses_[source][text_in(sample, "name")].push_back(pose);
    });
  }

  /// Joins each target to the row that it answers. If a sequence occurs twice (the plant
  /// restarted), joins it to the row nearest in log time.
  void join_targets() {
    std::multimap<std::uint64_t, std::size_t> by_sequence;
    for (std::size_t i = 0; i < rows_.size(); ++i) by_sequence.emplace(rows_[i].sequence, i);
    for (const Target& target : targets_) {
      if (!actuators_.has(target.actuator)) continue;
      const auto [first, last] = by_sequence.equal_range(target.answers);
      const auto distance_ns = [&](std::size_t row) {
        const std::uint64_t t = rows_[row].log_time_ns;
        return t > target.log_time_ns ? t - target.log_time_ns : target.log_time_ns - t;
      };
      const auto row = std::min_element(first, last, [&](const auto& a, const auto& b) {
        return distance_ns(a.second) < distance_ns(b.second);
      });
      if (row == last) continue;  // no row has this sequence
      actuators_.set(target.actuator, "target_mode", row->second,
                     target.mode ? target.mode : not_taken);
      actuators_.set(target.actuator, "target", row->second,
                     target.mode ? target.reference : not_taken);
    }
  }

  /// An ECU can follow a set-point at the earliest in the frame after the one that it answers. A
  /// sent set-point is written to that row and to all rows until the next one is sent. A followed
  /// set-point is written to the row of the frame that reports it.
  void join_set_points() {
    const auto order = row_order();
    std::map<std::uint64_t, std::size_t> row_of;
    for (const std::size_t row : order) row_of.emplace(rows_[row].sequence, row);
    for (const SetPoint& followed : followed_)
      if (const auto row = row_of.find(followed.sequence); row != row_of.end())
        write_set_point(row->second, followed, "followed");
    std::ranges::stable_sort(sent_, {}, &SetPoint::sequence);
    std::map<std::string, SetPoint> last_sent;
    auto next = sent_.begin();
    for (const std::size_t row : order) {
      for (; next != sent_.end() && next->sequence < rows_[row].sequence; ++next)
        last_sent.insert_or_assign(next->channel, *next);
      for (const auto& [channel, sent] : last_sent) write_set_point(row, sent, "sent");
    }
  }

  void write_set_point(std::size_t row, const SetPoint& value, const std::string& signal) {
    ecus_.set(value.channel, (signal + "_request").c_str(), row, value.request);
    ecus_.set(value.channel, signal.c_str(), row, value.counts);
  }

  std::string pose_source() const {
    if (!options_.pose_source.empty()) return options_.pose_source;
    return poses_.contains("motion_capture") ? "motion_capture" : "sim";
  }

  void join_poses() {
    const auto source = poses_.find(pose_source());
    if (source == poses_.end()) return;
    const std::vector<std::size_t> order = row_order();
    for (auto& [joint, poses] : source->second) {
      if (joints_.has(joint)) continue;
      std::ranges::stable_sort(poses, {}, &Pose::at_ns);
      for (std::size_t i = 0; i < order.size(); ++i) {
        const std::int64_t stamp_ns = rows_[order[i]].at_ns;
        const std::int64_t previous_stamp_ns = i ? rows_[order[i - 1]].at_ns : stamp_ns - 1;
        const auto next_pose = std::ranges::upper_bound(poses, stamp_ns, {}, &Pose::at_ns);
        const bool taken =
            next_pose != poses.begin() && std::prev(next_pose)->at_ns > previous_stamp_ns;
        constexpr const char* signals[] = {"qw", "qx", "qy", "qz"};
        for (std::size_t k = 0; k < 4; ++k)
          spherical_joints_.set(joint, signals[k], order[i],
                                taken ? std::prev(next_pose)->q[k] : not_taken);
      }
    }
  }

  /// Rows by time; equal times in the order of the file.
  std::vector<std::size_t> row_order() const {
    std::vector<std::size_t> order(rows_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::ranges::stable_sort(order, {}, [&](std::size_t i) { return rows_[i].at_ns; });
    return order;
  }

  Table assemble() {
    Table table{{{"time_s", {}}}};
    actuators_.move_into(table, rows_.size());
    joints_.move_into(table, rows_.size());
    spherical_joints_.move_into(table, rows_.size());
    ecus_.move_into(table, rows_.size());
    const std::vector<std::size_t> order = row_order();
    const std::int64_t start_ns = rows_[order.front()].at_ns;
    for (const Row& row : rows_)
      table.columns[0].values.push_back(static_cast<double>(row.at_ns - start_ns) / 1e9);
    if (options_.sequences) {
      Column& sequence = table.columns.emplace_back(Column{"sequence", {}});
      for (const Row& row : rows_) sequence.values.push_back(static_cast<double>(row.sequence));
    }
    if (std::ranges::is_sorted(order)) return table;
    for (Column& column : table.columns) {
      std::vector<double> sorted;
      for (const std::size_t row : order) sorted.push_back(column.values[row]);
      column.values = std::move(sorted);
    }
    return table;
  }

  const McapReader& recording_;
  const TableOptions& options_;
  std::map<std::uint16_t, TypeDescription> types_;
  std::set<std::string> robots_;
  std::vector<Row> rows_;
  FrameTimes times_;
  ColumnGroup actuators_, joints_, spherical_joints_, ecus_;
  std::vector<Target> targets_;
  std::vector<SetPoint> sent_, followed_;
  std::map<std::string, std::map<std::string, std::vector<Pose>>> poses_;
};

}  // namespace

Table table_of(const McapReader& recording, const TableOptions& options) {
  return Builder(recording, options).run();
}

}  // namespace recording
