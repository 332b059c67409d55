#pragma once
#include <concepts>
#include <functional>
#include <string>

#include "components/node/bus.hpp"
#include "components/node/gate.hpp"

/// The typed ends of a component: what a Node owns and polls.
namespace node {

/// Where a subscription's handler runs.
enum class Where {
  on_arrival,  ///< on DDS's thread, at once: for control
  in_loop      ///< in the component's loop: for what may take its time
};

/// One reader or writer, seen without its type.
class Port {
 public:
  virtual ~Port() = default;
  virtual std::uint32_t matched() const = 0;
  virtual void poll(bool) {}
  virtual Where where() const { return Where::on_arrival; }
  virtual std::uint64_t missed() const { return 0; }
};

/// Who speaks: filled into every message.
struct Identity {
  std::string robot, component;
  int priority = 0;
};

/// Publishes messages of one type in a component's name.
template <class M>
class Publisher final : public Port {
 public:
  Publisher(const Entity& participant, const Identity& identity)
      : writer_(participant), identity_(identity) {}

  void publish(M& message) {
    sign(message);
    writer_.write(message);
  }
  /// Keeps the sequence number the message carries.
  void publish_numbered(M& message) {
    sign(message);
    writer_.send(message);
  }
  std::uint32_t matched() const override { return writer_.matched(); }

 private:
  void sign(M& message) const {
    erp::assign(message.robot, identity_.robot);
    if constexpr (requires { message.controller; })
      erp::assign(message.controller, identity_.component);
    if constexpr (requires { message.component; } && !std::same_as<M, erp::LifecycleCommand>)
      erp::assign(message.component, identity_.component);
    if constexpr (requires { message.source; }) erp::assign(message.source, identity_.component);
    if constexpr (requires {
                    message.controller;
                    message.priority;
                  })
      message.priority = identity_.priority;
  }
  Writer<M> writer_;
  const Identity& identity_;
};

/// Hands arriving messages of this robot to a function, one at a time.
template <class M>
class Subscription final : public Port {
 public:
  Subscription(const Entity& participant, Wake& wake, Gate& gate, const bool& deliver, Where where,
               int depth, const Identity& identity, std::function<void(const M&)> use)
      : identity_(identity),
        use_(std::move(use)),
        gate_(gate),
        deliver_(deliver),
        where_(where),
        reader_(participant, where == Where::in_loop ? waking(wake) : Arrival{arrived, this},
                depth) {}

  /// In the gate: hands over what waits, or drops it while the component is not active.
  void poll(bool deliver) override {
    reader_.take([&](const M& message) {
      if (deliver && identity_.robot == message.robot) use_(message);
    });
  }
  Where where() const override { return where_; }
  std::uint32_t matched() const override { return reader_.matched(); }
  std::uint64_t missed() const override { return reader_.missed(); }

 private:
  static void arrived(void* with) {
    auto& self = *static_cast<Subscription*>(with);
    self.gate_.enter([&self] { self.poll(self.deliver_); });
  }

  const Identity& identity_;
  std::function<void(const M&)> use_;
  Gate& gate_;
  const bool& deliver_;
  Where where_;
  Reader<M> reader_;  // last: messages may arrive as soon as it exists
};

}  // namespace node
