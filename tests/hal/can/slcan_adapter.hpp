#pragma once
#include <fcntl.h>
#include <poll.h>
#include <pty.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

#include <net/if.h>

#include <atomic>
#include <catch2/catch.hpp>
#include <cstdlib>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace can_test {

/// A serial CAN adapter, emulated on a pseudo-terminal and connected to the kernel's slcan: a real
/// CAN device with states, error frames and bus-off, which virtual interfaces do not have.
class SlcanAdapter {
 public:
  SlcanAdapter() {
    REQUIRE(::openpty(&master_, &slave_, nullptr, nullptr, nullptr) == 0);
    termios raw{};
    ::tcgetattr(slave_, &raw);
    ::cfmakeraw(&raw);
    ::tcsetattr(slave_, TCSANOW, &raw);
    const int slcan_discipline = 17;
    REQUIRE(::ioctl(slave_, TIOCSETD, &slcan_discipline) == 0);
    ifreq request{};
    REQUIRE(::ioctl(slave_, SIOCGIFNAME, request.ifr_name) == 0);
    interface_ = request.ifr_name;
    reader_ = std::thread([this] { read(); });
    system("ip link set " + interface_ + " txqueuelen 16 type can bitrate 1000000");
    system("ip link set " + interface_ + " up");
  }
  ~SlcanAdapter() {
    done_ = true;
    reader_.join();
    ::close(slave_), ::close(master_);
  }

  std::string where() const { return "socketcan:" + interface_; }
  const std::string& interface() const { return interface_; }

  /// Sends a message of the adapter to the kernel: a frame t1808…, counters sw100020, bus-off
  /// sb256256, missing acknowledgement e1a.
  void send(const std::string& text) {
    const std::string line = text + "\r";
    REQUIRE(::write(master_, line.data(), line.size()) == ssize_t(line.size()));
  }
  /// Stops or resumes reading from the line; while stopped, the adapter's queue becomes full.
  void stall(bool is_stalled) { stalled_ = is_stalled; }

  /// Frames that the kernel has passed to the adapter, as text: t0808…
  std::vector<std::string> sent() {
    const std::lock_guard lock(guard_);
    return sent_;
  }
  /// Number of times that the channel was opened: once each time the interface comes up.
  int opened() const { return opened_; }

  static void system(const std::string& command) {
    INFO(command);
    REQUIRE(std::system(command.c_str()) == 0);
  }

 private:
  void read() {
    std::string line;
    while (!done_) {
      pollfd readable{master_, POLLIN, 0};
      if (stalled_ || ::poll(&readable, 1, 5) <= 0) {
        if (stalled_) ::usleep(500);
        continue;
      }
      char bytes[512];
      const ssize_t n = ::read(master_, bytes, sizeof bytes);
      for (ssize_t i = 0; i < n; ++i)
        if (bytes[i] != '\r') line += bytes[i];
        else handle_line(std::exchange(line, ""));
    }
  }
  void handle_line(const std::string& line) {
    const std::lock_guard lock(guard_);
    if (line.starts_with("t")) sent_.push_back(line);
    if (line == "O") ++opened_;
  }

  int master_ = -1, slave_ = -1;
  std::string interface_;
  std::atomic<bool> stalled_ = false, done_ = false;
  std::atomic<int> opened_ = 0;
  std::mutex guard_;
  std::vector<std::string> sent_;
  std::thread reader_;
};

}  // namespace can_test
