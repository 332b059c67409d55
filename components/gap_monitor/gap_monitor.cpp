#include "components/gap_monitor/gap_monitor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace {

// Deep enough for what arrives while a window is judged (chosen).
constexpr int depth = 2000;
constexpr std::int64_t patience_ns = 5'000'000'000;

erp::Robot model_of(const GapMonitor::Params& params, const erp::Robot& robot) {
  if (params.model.empty()) return robot;
  const auto folder = std::filesystem::path(params.place.file).parent_path();
  return erp::read_robot((folder / params.model).string());
}

std::string name_of(const sim::diagnosis::StageGap& gap) {
  return fmt::format("{} of {}", sim::effects::word(gap.stage), gap.on);
}

}  // namespace

GapMonitor::GapMonitor(const Params& params, const erp::Robot& robot, node::Node& node)
    : params_(params),
      node_(node),
      window_(model_of(params, robot), params.window_s),
      out_(node.advertise<erp::StageResidual>()) {
  node.subscribe<erp::JointState>([this](const erp::JointState& state) { window_.hear(state); },
                                  depth, node::Where::in_loop);
  node.subscribe<erp::SensorFrame>(
      [this](const erp::SensorFrame& frame) {
        window_.hear(frame), heard_ = ever_heard_ = true;
        judged_ns_ = std::min(judged_ns_, frame.stamp_ns);  // another graph's time begins anew
        if (1e-9 * double(frame.stamp_ns - judged_ns_) < params_.every_s) return;
        judged_ns_ = frame.stamp_ns;
        judge();
      },
      depth, node::Where::in_loop);
  node.every(patience_ns, [this] { tell_waiting(); });
}

void GapMonitor::tell_waiting() {
  const bool silent = !heard_, told = told_waiting_;
  heard_ = false, told_waiting_ = silent;
  if (!silent || told) return;
  node_.report(erp::Severity::info, "", "waiting",
               ever_heard_
                   ? "no sensor frame for 5 s: has the graph ended? The next one is watched too"
                   : "no sensor frame yet: launch a graph, on the same ERP_DOMAIN");
}

void GapMonitor::judge() {
  std::string why;
  const auto gaps = window_.judge(why);
  if (!why.empty() && !told_why_)
    node_.report(erp::Severity::warning, "", "not_judged", why), told_why_ = true;
  if (gaps.empty()) return;
  publish(gaps);
  for (const auto& gap : gaps) tell(gap);
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

void GapMonitor::tell(const sim::diagnosis::StageGap& gap) {
  Said& said = said_[name_of(gap)];
  said.open = gap.open ? said.open + 1 : 0;
  said.closed = gap.judged && !gap.open ? said.closed + 1 : 0;
  if (!said.told && said.open >= params_.times) {
    said.told = true;
    node_.report(erp::Severity::warning, gap.on, "gap_open",
                 fmt::format("{}: robot and model part, {:.3g} {} rms against {:.3g} of noise",
                             name_of(gap), gap.rms, gap.unit, gap.floor));
  }
  if (said.told && said.closed >= params_.times) {
    said.told = false;
    node_.report(erp::Severity::info, gap.on, "gap_closed",
                 name_of(gap) + " is at its floor again");
  }
}
