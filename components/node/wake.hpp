#pragma once
#include <cstdint>

/// Wakes the main loop of a component: DDS listeners and other threads raise it, the main loop polls
/// its descriptor.
namespace node {

class Wake {
 public:
  Wake();
  ~Wake();
  Wake(const Wake&) = delete;
  Wake& operator=(const Wake&) = delete;
  void raise();  ///< any thread; async-signal-safe
  void clear();
  int descriptor() const { return descriptor_; }

 private:
  int descriptor_;
};

}  // namespace node
