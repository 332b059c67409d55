#pragma once
#include <atomic>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "components/node/bus.hpp"
#include "components/node/clock.hpp"
#include "hal/can/bus.hpp"
#include "interfaces/topics.hpp"

namespace faults {

/// Records a CAN bus, frame by frame, with the kernel's timestamps.
class BusRecorder : erp::FrameSink {
 public:
  struct RecordedFrame {
    std::int64_t at_ns;  ///< since 1970
    erp::CanFrame frame;
  };
  explicit BusRecorder(const std::vector<std::string>& buses) {
    for (const auto& where : buses) buses_.push_back(erp::open_bus(where));
    for (const auto& bus : buses_) {
      bus->record(this);
      threads_.emplace_back([this, &bus] { record(*bus); });
    }
  }
  ~BusRecorder() {
    done_ = true;
    for (auto& thread : threads_) thread.join();
  }

  std::vector<RecordedFrame> since(std::int64_t from_ns) {
    const std::lock_guard lock(guard_);
    std::vector<RecordedFrame> matching;
    for (const RecordedFrame& recorded : frames_)
      if (recorded.at_ns >= from_ns) matching.push_back(recorded);
    return matching;
  }
  /// Time of the first frame after `from_ns` for which `condition` holds; 0: none yet.
  template <class Condition>
  std::int64_t first(std::int64_t from_ns, Condition condition) {
    for (const RecordedFrame& recorded : since(from_ns))
      if (condition(recorded.frame)) return recorded.at_ns;
    return 0;
  }
  /// Sends on the first bus, as a foreign node.
  void send(std::span<const erp::CanFrame> frames) { buses_[0]->send(frames); }
  void clear() {
    const std::lock_guard lock(guard_);
    frames_.clear();
  }

 private:
  void frame(const erp::CanFrame& frame, std::int64_t stamp_ns, bool is_own) override {
    const std::lock_guard lock(guard_);
    if (!is_own) frames_.push_back({stamp_ns, frame});
  }
  void record(erp::CanBus& bus) {
    std::array<erp::CanFrame, 64> frames;
    while (!done_) bus.receive(frames, 0.02);
  }
  std::vector<std::unique_ptr<erp::CanBus>> buses_;
  std::mutex guard_;
  std::vector<RecordedFrame> frames_;
  std::atomic<bool> done_ = false;
  std::vector<std::thread> threads_;
};

/// Records the `event` topic.
class EventRecorder {
 public:
  struct RecordedEvent {
    std::int64_t at_ns;
    std::string component, subject, code, text;
  };
  explicit EventRecorder(const node::Entity& participant) : events_(participant, wake_, 64) {
    thread_ = std::thread([this] { record(); });
  }
  ~EventRecorder() {
    done_ = true;
    thread_.join();
  }
  /// Stamp of the first event with this code after `from_ns`; 0: none yet. An empty subject matches
  /// all.
  std::int64_t first(std::int64_t from_ns, const std::string& code,
                     const std::string& subject = "") {
    const std::lock_guard lock(guard_);
    for (const RecordedEvent& recorded : recorded_)
      if (recorded.at_ns >= from_ns && recorded.code == code &&
          (subject.empty() || recorded.subject == subject))
        return recorded.at_ns;
    return 0;
  }
  std::vector<RecordedEvent> since(std::int64_t from_ns) {
    const std::lock_guard lock(guard_);
    std::vector<RecordedEvent> matching;
    for (const RecordedEvent& recorded : recorded_)
      if (recorded.at_ns >= from_ns) matching.push_back(recorded);
    return matching;
  }

 private:
  void record() {
    while (!done_) {
      events_.take([this](const erp::Event& e) {
        const std::lock_guard lock(guard_);
        recorded_.push_back({e.stamp_ns, e.component, e.subject, e.code, e.text});
      });
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  node::Wake wake_;
  node::Reader<erp::Event> events_;
  std::mutex guard_;
  std::vector<RecordedEvent> recorded_;
  std::atomic<bool> done_ = false;
  std::thread thread_;
};

}  // namespace faults
