#pragma once

/// Signals as a readable descriptor. Create it before any thread starts: all threads then block
/// these signals.
namespace launch {

class Signals {
 public:
  Signals();  ///< SIGINT, SIGTERM and SIGHUP (terminal closed)
  ~Signals();
  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;
  int descriptor() const { return descriptor_; }
  int take();  ///< the number of a pending signal, 0 if there is none

 private:
  int descriptor_;
};

}  // namespace launch
