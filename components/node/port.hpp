#pragma once
#include <concepts>
#include <functional>
#include <string>

#include "components/node/bus.hpp"
#include "components/node/gate.hpp"

/// Typed publishers and subscriptions, which a Node owns and polls.
namespace node {

/// Where a subscription's handler runs.
enum class Where {
  on_arrival,  ///< on DDS's thread, immediately: for control
  in_loop      ///< in the component's main loop: for slow handlers
};

/// Type-erased interface of one reader or writer.
class Port {
 public:
  virtual ~Port() = default;
  virtual std::uint32_t matched() const = 0;
  virtual void poll(bool) {}
  virtual Where where() const { return Where::on_arrival; }
  virtual std::uint64_t missed() const { return 0; }
};

/// The sender's identity, written into every message.
struct Identity {
  std::string robot, component;
  int priority = 0;
};

/// Publishes messages of one type with the component's identity.
template <class M>
class Publisher final : public Port {
 public:
  Publisher(const Entity& participant, const Identity& identity, int depth)
      : writer_(participant, depth), identity_(identity) {}

  void publish(M& message) {
    set_identity(message);
    writer_.write(message);
  }
  /// Keeps the sequence number of the message.
  void publish_numbered(M& message) {
    set_identity(message);
    writer_.send(message);
  }
  std::uint32_t matched() const override { return writer_.matched(); }

 private:
  void set_identity(M& message) const {
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

/// Passes arriving messages of this robot to a handler, one at a time.
template <class M>
class Subscription final : public Port {
 public:
  Subscription(const Entity& participant, Wake& wake, Gate& gate, const bool& deliver, Where where,
               int depth, const Identity& identity, std::function<void(const M&)> handler)
      : identity_(identity),
        handler_(std::move(handler)),
        gate_(gate),
        deliver_(deliver),
        where_(where),
        reader_(participant,
                where == Where::in_loop ? wake_callback(wake) : DataCallback{on_data, this}, depth,
                identity.robot) {}

  /// Called with the gate locked. Passes available messages to the handler, or drops them if
  /// `deliver` is false.
  void poll(bool deliver) override {
    reader_.take([&](const M& message) {
      if (deliver && identity_.robot == message.robot) handler_(message);
    });
  }
  Where where() const override { return where_; }
  std::uint32_t matched() const override { return reader_.matched(); }
  std::uint64_t missed() const override { return reader_.missed(); }

 private:
  static void on_data(void* subscription) {
    auto& self = *static_cast<Subscription*>(subscription);
    self.gate_.enter([&self] { self.poll(self.deliver_); });
  }

  const Identity& identity_;
  std::function<void(const M&)> handler_;
  Gate& gate_;
  const bool& deliver_;
  Where where_;
  Reader<M> reader_;  // last: messages may arrive as soon as the reader exists
};

}  // namespace node
