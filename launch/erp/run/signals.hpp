#pragma once

/// Interruptions as something to read. Make it before any thread starts, so that all block them.
namespace launch {

class Signals {
 public:
  Signals();  ///< SIGINT, SIGTERM and SIGHUP, the closing of the terminal
  ~Signals();
  Signals(const Signals&) = delete;
  Signals& operator=(const Signals&) = delete;
  int descriptor() const { return descriptor_; }
  int take();  ///< the number of one that arrived, 0 when none did

 private:
  int descriptor_;
};

}  // namespace launch
