#pragma once
#include <cstdint>

/// What a component sleeps on: DDS listeners and signals raise it, the loop polls its descriptor.
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
