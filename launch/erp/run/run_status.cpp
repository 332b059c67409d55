#include "launch/erp/run/component_row.hpp"
#include "launch/erp/run/run.hpp"
#include "launch/erp/text/duration.hpp"

/// The status of a run.
namespace launch {
namespace {

constexpr std::int64_t max_heartbeat_age_ns = 1'000'000'000;  // ten heartbeats

template <class Enum>
std::string name_in(Enum value) {
  for (const auto& [name, named] : xml::Names<Enum>::list)
    if (named == value) return name;
  return "";
}

}  // namespace

std::string Run::state_of(std::size_t index) const {
  const Phase phase = supervisor_.phase(index);
  const bool on_bus = phase == Phase::active || phase == Phase::inactive;
  if (on_bus && time_.now_ns() - members_[index].heartbeat_ns > max_heartbeat_age_ns)
    return "silent";
  return name_of(phase);
}

Row Run::row(std::size_t index) {
  Member& member = members_[index];
  Row row{.name = plan_.processes[index].name, .state = state_of(index)};
  row.restarts = static_cast<long>(supervisor_.restarts(index));
  if (member.process) {
    row.pid = member.process->pid();
    row.cpu_percent = member.share.measure(member.process->pid(), time_.now_ns());
  }
  if (member.heartbeat) fill_measurements(row, *member.heartbeat);
  return row;
}

Status Run::status() {
  Status status{.graph = graph_.name,
                .device = name_in(graph_.device),
                .time = name_in(graph_.time),
                .stage = name_of(supervisor_.stage()),
                .elapsed_s = time_.elapsed_s(),
                .device_s = time_.device_s(),
                .remaining_s = supervisor_.stage() == Stage::running ? time_.remaining_s() : -1};
  for (std::size_t i = 0; i < members_.size(); ++i) status.rows.push_back(row(i));
  return status;
}

}  // namespace launch
