#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <future>
#include <ostream>
#include <stdexcept>

#include "components/node/clock.hpp"
#include "interfaces/emergency.hpp"
#include "interfaces/xml/words.hpp"
#include "launch/erp/command/command.hpp"
#include "launch/erp/command/homing_move.hpp"

namespace launch {
namespace {

constexpr double rest_share = 0.4, low_share = 0.25;  // chosen: of the largest tension
constexpr std::size_t poses = 6;                      // chosen
/// Above the first, more poses are taken; above the second, homing fails. Chosen: 30 mm of moment arm
/// make 1 mm an error of 2 degrees, and the estimate of sigma is conservative.
constexpr double good_sigma_m = 0.0005, largest_sigma_m = 0.0025;
/// Time between two messages with zeros: the answer to the first must have arrived, because a second
/// one makes the zero unknown again.
constexpr std::int64_t zero_period_ns = 1'000'000'000;
constexpr std::int64_t zero_timeout_ns = 4 * zero_period_ns;

bool is_known(const RobotLink::Robot& robot, const std::string& actuator) {
  const auto* sample = robot.sample(actuator);
  return sample && (sample->valid & erp::valid::line);
}

/// The robot.xml in the command line of the robot's plant. Throws std::invalid_argument if the plant
/// runs on another computer.
std::string file_of(const RobotLink& link, const std::string& robot) {
  for (const auto& peer : link.peers()) {
    if (peer.robot != robot || peer.role != node::plant_role) continue;
    std::ifstream file("/proc/" + std::to_string(peer.pid) + "/cmdline");
    for (std::string word; std::getline(file, word, '\0');)
      if (word == "--robot" && std::getline(file, word, '\0')) return word;
  }
  throw std::invalid_argument("the plant of " + robot +
                              " runs on another computer; give its robot.xml with --xml");
}

/// Tensions that move the robot through different poses: low and high, in another pattern each time.
std::vector<std::vector<double>> tension_patterns(std::size_t actuators, double largest_N) {
  std::vector<std::vector<double>> sets;
  for (std::size_t k = 0; k < poses; ++k) {
    auto& set = sets.emplace_back();
    for (std::size_t a = 0; a < actuators; ++a) {
      const bool is_high = (a * 2654435761U >> (7 + k)) & 1;  // multiplicative hash
      set.push_back(is_high ? largest_N : low_share * largest_N);
    }
  }
  return sets;
}

class Home {
 public:
  Home(RobotLink& link, const HomeOptions& options, std::ostream& out)
      : link_(link), options_(options), out_(out), name_(link.choose(options.robot)) {
    const Names all = actuators_of(robot());
    for (const auto& actuator : options.actuators)
      if (!robot().has_actuator(actuator))
        throw std::invalid_argument("the robot has no actuator \"" + actuator + "\"; " +
                                    xml::did_you_mean(actuator, all));
    for (const auto& name : all)
      if (options.all || std::ranges::find(options.actuators, name) != options.actuators.end() ||
          (options.actuators.empty() && !is_known(robot(), name)))
        names_.push_back(name);
  }

  int run() {
    if (names_.empty()) return out_ << name_ << ": the zeros of all encoders are known\n", 0;
    if (options_.here) return set_zeros({}, [] {}), 0;
    const erp::Robot model =
        erp::read_robot(options_.xml.empty() ? file_of(link_, name_) : options_.xml);
    HomingMove move(link_, model, names_, options_.priority);
    const auto lines = estimate(move, model);
    try {
      set_zeros(lines, [&] { move.hold(); });
    } catch (...) {
      move.release();
      throw;
    }
    move.release();
    return 0;
  }

 private:
  RobotLink::Robot& robot() { return link_.robot(name_); }

  sim::HomedLines estimate(HomingMove& move, const erp::Robot& model) {
    sim::HomingEstimate estimate(model);
    std::vector<bool> known;
    for (const auto& actuator : model.actuators)
      known.push_back(is_known(robot(), actuator.name) &&
                      std::ranges::find(names_, actuator.name) == names_.end());
    out_ << fmt::format("{}: winding {} lines to at most {:.4g} N\n", name_, names_.size(),
                        options_.tension_N)
         << std::flush;
    const auto first = move.rest(rest_share * options_.tension_N);
    auto lines = estimate.find(std::vector{first}, known, {sim::starting_pose(model)});
    if (largest_sigma_m_of(lines) < good_sigma_m) return lines;
    const auto sets = tension_patterns(model.actuators.size(), options_.tension_N);
    out_ << "joint " << estimate.unmeasured().front() << " has no sensor: moving the robot through "
         << poses << " poses\n";
    const auto snapshots = move.follow(sets, out_);
    auto computed = std::async(std::launch::async, [&] {
      return estimate.find(snapshots, known,
                           estimate.simulate(sets, HomingMove::ramp_s, HomingMove::hold_s));
    });
    while (computed.wait_for(std::chrono::milliseconds(0)) != std::future_status::ready)
      link_.watch(1, [&] { return move.hold(), true; });
    lines = computed.get();
    if (largest_sigma_m_of(lines) < largest_sigma_m) return lines;
    move.release();
    throw std::runtime_error(fmt::format(
        "the poses determine the lines to ±{:.1f} mm only; add joint sensors or potentiometers, or "
        "bring the robot into its starting pose and give --here",
        1e3 * largest_sigma_m_of(lines)));
  }

  static double largest_sigma_m_of(const sim::HomedLines& lines) {
    return *std::ranges::max_element(lines.sigma_m);
  }

  /// Sets the zeros, and prints the lines. Without `lines`, all are 0. `meanwhile` is called repeatedly.
  template <class Meanwhile>
  void set_zeros(const sim::HomedLines& lines, Meanwhile&& meanwhile) {
    std::int64_t sent_ns = 0;
    const std::int64_t began_ns = node::monotonic_ns();
    bool is_done = false;
    std::vector<erp::ActuatorReference> zeros;
    link_.watch(zero_timeout_ns, [&] {
      const auto now_ns = node::monotonic_ns();
      meanwhile();
      is_done = now_ns - began_ns > zero_period_ns / 2 &&
                std::ranges::all_of(names_, [&](const auto& n) { return is_known(robot(), n); });
      if (is_done || now_ns - sent_ns < zero_period_ns) return is_done;
      zeros = zeros_now(lines);
      link_.command(name_, zeros, options_.priority);
      sent_ns = now_ns;
      return false;
    });
    if (!is_done) throw std::runtime_error("the zero was not set: " + open_zeros());
    for (std::size_t k = 0; k < zeros.size(); ++k)
      out_ << fmt::format("{}: line {:+.1f} mm from the starting pose\n", names_[k],
                          1e3 * zeros[k].reference);
  }

  std::vector<erp::ActuatorReference> zeros_now(const sim::HomedLines& lines) {
    const Names all = actuators_of(robot());
    std::vector<erp::ActuatorReference> zeros;
    for (const auto& name : names_) {
      const auto a = static_cast<std::size_t>(std::ranges::find(all, name) - all.begin());
      auto& zero = zeros.emplace_back();
      erp::assign(zero.name, name);
      zero.mode = erp::set_zero_mode;
      zero.reference =
          lines.offset_m.empty() ? 0 : robot().sample(name)->line_m + lines.offset_m[a];
    }
    return zeros;
  }

  std::string open_zeros() {
    std::string open, reason;
    for (const auto& name : names_) {
      if (is_known(robot(), name)) continue;
      open += (open.empty() ? "" : ", ") + name;
      if (const auto* owner = robot().owner(name); owner && owner->reason[0])
        reason = std::string("; ") + owner->reason;
    }
    return open + reason;
  }

  RobotLink& link_;
  const HomeOptions& options_;
  std::ostream& out_;
  std::string name_;
  Names names_;  ///< in the order of robot.xml
};

}  // namespace

int home_robot(const HomeOptions& options, std::ostream& out) {
  RobotLink link("home", "erp_home");
  link.find_robots();
  return Home(link, options, out).run();
}

}  // namespace launch
