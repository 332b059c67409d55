#include "components/gap_monitor/gap_monitor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace {

// Chosen: room for the messages that arrive during an evaluation.
constexpr int queue_depth = 2000;
constexpr std::int64_t silence_ns = 5'000'000'000;  // chosen: without frames, before a report

erp::Robot model_of(const GapMonitor::Params& params, const erp::Robot& robot) {
  if (params.model.empty()) return robot;
  const auto folder = std::filesystem::path(params.place.file).parent_path();
  return erp::read_robot((folder / params.model).string());
}

std::string stage_name(const sim::diagnosis::StageGap& gap) {
  return fmt::format("{} of {}", sim::effects::word(gap.stage), gap.on);
}

}  // namespace

GapMonitor::GapMonitor(const Params& params, const erp::Robot& robot, node::Node& node)
    : params_(params),
      node_(node),
      window_(model_of(params, robot), params.window_s),
      out_(node.advertise<erp::StageResidual>()) {
  node.subscribe<erp::JointState>([this](const erp::JointState& state) { window_.receive(state); },
                                  queue_depth, node::Where::in_loop);
  node.subscribe<erp::SensorFrame>(
      [this](const erp::SensorFrame& frame) {
        window_.receive(frame), received_ = ever_received_ = true;
        last_evaluation_ns_ =
            std::min(last_evaluation_ns_, frame.stamp_ns);  // a new graph restarts at 0
        if (1e-9 * double(frame.stamp_ns - last_evaluation_ns_) < params_.every_s) return;
        last_evaluation_ns_ = frame.stamp_ns;
        evaluate();
      },
      queue_depth, node::Where::in_loop);
  node.every(silence_ns, [this] { report_silence(); });
}

void GapMonitor::report_silence() {
  const bool silent = !received_, reported = silence_reported_;
  received_ = false, silence_reported_ = silent;
  if (!silent || reported) return;
  node_.report(erp::Severity::info, "", "waiting",
               ever_received_ ? "no sensor frame for 5 s: check whether the graph is running; "
                                "monitoring continues with "
                                "the next frame"
                              : "no sensor frame yet: launch a graph with the same ERP_DOMAIN");
}

void GapMonitor::evaluate() {
  std::string reason;
  const auto gaps = window_.evaluate(reason);
  if (!reason.empty() && !failure_reported_)
    node_.report(erp::Severity::warning, "", "not_evaluated", reason), failure_reported_ = true;
  if (gaps.empty()) return;
  publish(gaps);
  for (const auto& gap : gaps) report(gap);
  node_.count_step(window_.stamp_ns());
}

void GapMonitor::publish(const std::vector<sim::diagnosis::StageGap>& gaps) {
  message_.stages._length = 0;
  message_.stamp_ns = window_.stamp_ns(), message_.window_s = params_.window_s;
  for (const auto& gap : gaps) {
    if (!gap.judged) continue;
    erp::StageSample sample{};
    erp::assign_shortened(sample.stage, sim::effects::word(gap.stage));
    erp::assign_shortened(sample.on, gap.on);
    erp::assign_shortened(sample.unit, gap.unit);
    sample.residual = gap.rms, sample.floor = gap.floor, sample.open = gap.open;
    erp::append(message_.stages, sample);
  }
  out_.publish(message_);
}

void GapMonitor::report(const sim::diagnosis::StageGap& gap) {
  StageState& state = states_[stage_name(gap)];
  state.open_count = gap.open ? state.open_count + 1 : 0;
  state.closed_count = gap.judged && !gap.open ? state.closed_count + 1 : 0;
  if (!state.reported && state.open_count >= params_.consecutive) {
    state.reported = true;
    node_.report(
        erp::Severity::warning, gap.on, "gap_open",
        fmt::format(
            "{}: robot and model differ, residual {:.3g} {} rms, noise floor {:.3g} {}; run "
            "`erp gap diagnose` on a recording",
            stage_name(gap), gap.rms, gap.unit, gap.floor, gap.unit));
  }
  if (state.reported && state.closed_count >= params_.consecutive) {
    state.reported = false;
    node_.report(erp::Severity::info, gap.on, "gap_closed",
                 stage_name(gap) + ": the residual is at its noise floor again");
  }
}
