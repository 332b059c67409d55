#pragma once
#include <iostream>
#include <optional>
#include <string>
#include <tuple>

#include "components/node/node.hpp"
#include "interfaces/recording/error.hpp"
#include "interfaces/robot/robot.hpp"
#include "interfaces/xml/xml.hpp"

/// The whole main of a component:
///   int main(int argc, char** argv) { return node::run<MyController>(argc, argv); }
///
/// A component is a class with `Params`, a constructor (Params) or (Params, const erp::Robot&) and
///   Out step(const In& in, double dt_s, const node::Latest<More>&… more)
/// `step` is called once per In. Out is a message or std::optional of one. In lockstep the call
/// waits for the `More` messages that answer the same frame, so a repeated run is identical.
/// Optional members:
///   bool accepts(const More&) const   selects messages when several components publish them
///   asynchronous_joint_state          joint_state is not one per frame; do not wait for it
///   in_background                     run at normal priority: the component is not in the control
///                                     loop. All others use real-time priority if permitted.
///   static const char* role(const Params&)   the robot has one component of this role (peer.hpp)
/// A constructor (Params, const erp::Robot&, node::Node&) gives access to the node, for additional
/// ports. A class with this constructor and without `step` makes all of its ports itself.
namespace node {

/// The newest message of an additional input topic.
template <class M>
struct Latest {
  M message;
  bool received = false;
  double age_s = 0.0;  ///< time since arrival
  std::int64_t arrived_ns = 0;
  std::int64_t period_ns = 0;  ///< difference of the last two stamps; 0 before the second
  explicit operator bool() const { return received; }
  const M* operator->() const { return &message; }
};

namespace detail {

inline constexpr int timeout_checks = 50;  // chosen: per lockstep timeout

template <class Out>
struct Unwrapped {
  using type = Out;
};
template <class M>
struct Unwrapped<std::optional<M>> {
  using type = M;
};

template <class T, class Out, class In, class... More>
class Stepper {
 public:
  using OutMessage = typename Unwrapped<Out>::type;
  using Step = Out (T::*)(const In&, double, const Latest<More>&...);

  Stepper(Node& node, T& component, Step step)
      : node_(node), component_(component), step_(step), out_(node.advertise<OutMessage>()) {
    more_ports_ =
        std::make_tuple(&node.subscribe<More>([this](const More& m) { on_message(m); })...);
    node.subscribe<In>([this](const In& in) {
      pending_ = in, is_pending_ = true, pending_since_ns_ = monotonic_ns(), try_step();
    });
    if (sizeof...(More) && node.clock().lockstep())
      node.every(lockstep_timeout_ns / timeout_checks, [this] { try_step(); });
  }

 private:
  template <class M>
  void on_message(const M& message) {
    if constexpr (requires { component_.accepts(message); })
      if (!component_.accepts(message)) return;
    auto& latest = std::get<Latest<M>>(more_);
    if (latest.received) latest.period_ns = message.stamp_ns - latest.message.stamp_ns;
    latest.message = message;
    latest.received = true;
    latest.arrived_ns = node_.clock().lockstep() ? message.stamp_ns : monotonic_ns();
    try_step();
  }

  /// In lockstep: true if the input M belongs to the current frame or has no publisher.
  template <class M>
  bool is_current() const {
    const auto& latest = std::get<Latest<M>>(more_);
    const auto must_wait = [&](bool belongs_to_frame) {
      return std::get<Subscription<M>*>(more_ports_)->matched() > 0 &&
             !(latest.received && belongs_to_frame);
    };
    constexpr bool asynchronous = requires { T::asynchronous_joint_state; };
    if constexpr (requires(M m) { m.answers; })
      return !must_wait(latest->answers >= pending_.sequence);
    // Compares stamps: behind a gateway, frames and the simulator's joint states have different
    // sequence numbers.
    if constexpr (std::same_as<M, erp::JointState> && !asynchronous)
      return !must_wait(latest->stamp_ns >= pending_.stamp_ns);
    // Images are periodic but not one per frame: the next is due one period after the last.
    if constexpr (std::same_as<M, erp::ImagePoint>)
      return latest.period_ns == 0 ||
             !must_wait(latest->stamp_ns + latest.period_ns > pending_.stamp_ns);
    return true;
  }

  void try_step() {
    if (!is_pending_) return;
    if (node_.clock().lockstep() && !(is_current<More>() && ...) &&
        monotonic_ns() - pending_since_ns_ < lockstep_timeout_ns)
      return;
    is_pending_ = false;
    node_.clock().advance(pending_.stamp_ns);
    const auto now_ns = node_.clock().elapsed_ns();
    ((std::get<Latest<More>>(more_).age_s =
          1e-9 * static_cast<double>(now_ns - std::get<Latest<More>>(more_).arrived_ns)),
     ...);
    const double dt_s = interval_.add_s(pending_.stamp_ns, now_ns);
    publish((component_.*step_)(pending_, dt_s, std::get<Latest<More>>(more_)...));
    node_.count_step(pending_.stamp_ns);
  }

  void publish(Out&& out) {
    if constexpr (std::same_as<Out, OutMessage>) {
      send(out);
    } else if (out) {
      send(*out);
    } else if (node_.clock().lockstep()) {
      OutMessage empty;  // an empty answer, so that the other components do not wait
      send(empty);
    }
  }
  void send(OutMessage& message) {
    constexpr bool uses_frame_stamp =
        std::same_as<OutMessage, erp::JointState> || std::same_as<OutMessage, erp::JointTarget>;
    message.stamp_ns = uses_frame_stamp ? pending_.stamp_ns : node_.clock().stamp_ns();
    if constexpr (requires { message.answers; }) message.answers = pending_.sequence;
    if constexpr (std::same_as<OutMessage, erp::JointState>) {
      message.sequence = pending_.sequence;  // of the frame that it describes
      out_.publish_numbered(message);
    } else {
      out_.publish(message);
    }
  }

  Node& node_;
  T& component_;
  Step step_;
  Publisher<OutMessage>& out_;
  std::tuple<Latest<More>...> more_;
  std::tuple<Subscription<More>*...> more_ports_;
  In pending_;
  bool is_pending_ = false;
  std::int64_t pending_since_ns_ = 0;
  Interval interval_;
};

template <class T, class Out, class In, class... More>
auto make_stepper(Node& node, T& component,
                  Out (T::*step)(const In&, double, const Latest<More>&...)) {
  return std::make_unique<Stepper<T, Out, In, More...>>(node, component, step);
}

template <class Params>
Params read_params(const Options& options) {
  Params params;
  if (!options.config.empty()) xml::read_into(params, options.config, options.type);
  for (const auto& [key, value] : options.settings) xml::set(params, key, value);
  return params;
}

/// A component may define further checks of its parameters: static void check(const Params&).
template <class T>
void check(const Options& options) {
  const auto params = read_params<typename T::Params>(options);
  if constexpr (requires { T::check(params); }) T::check(params);
}

template <class T>
std::string role_of(const typename T::Params& params) {
  if constexpr (requires { T::role(params); }) return T::role(params);
  else return "";
}

template <class T>
int run_component(const Options& options) {
  const auto params = read_params<typename T::Params>(options);
  const erp::Robot robot = erp::read_robot(options.robot);
  constexpr bool in_control_loop = !requires { T::in_background; };
  Node node(options, robot.name,
            in_control_loop ? Node::Scheduling::real_time : Node::Scheduling::normal,
            role_of<T>(params));
  T component = [&] {
    if constexpr (std::constructible_from<T, typename T::Params, const erp::Robot&, Node&>)
      return T(params, robot, node);
    else if constexpr (std::constructible_from<T, typename T::Params, const erp::Robot&>)
      return T(params, robot);
    else return T(params);
  }();
  if constexpr (requires { &T::step; }) {
    const auto stepper = make_stepper(node, component, &T::step);
    return node.spin();
  } else {
    return node.spin();
  }
}

}  // namespace detail

/// Exit codes: 0 success, 1 failure, 2 invalid usage or input.
template <class T>
int run(int argc, char** argv) {
  int exit_code = -1;
  const Options options = parse_options(argc, argv, xml::describe<typename T::Params>(), exit_code);
  if (exit_code >= 0) return exit_code;
  try {
    if (options.check) return detail::check<T>(options), 0;
    if (options.robot.empty())
      throw std::invalid_argument("--robot is missing: give the robot.xml of the robot");
    return detail::run_component<T>(options);
  } catch (const xml::Errors& error) {
    std::cerr << error.what() << '\n';
    return 2;
  } catch (const std::invalid_argument& error) {
    std::cerr << options.name << ": " << error.what() << '\n';
    return 2;
  } catch (const recording::WriteError& error) {
    std::cerr << options.name << ": " << error.what() << '\n';
    return 1;
  } catch (const recording::RecordingError& error) {
    std::cerr << options.name << ": " << error.what() << '\n';
    return 2;
  } catch (const std::exception& error) {
    std::cerr << options.name << ": " << error.what() << '\n';
    return 1;
  }
}

}  // namespace node
