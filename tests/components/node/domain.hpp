#pragma once
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <stdexcept>
#include <string>

/// Reserves a DDS domain until this process ends. False if another process has reserved it.
inline bool reserve_domain(int id) {
  const std::string name = "erp_test_domain_" + std::to_string(id);
  sockaddr_un address{};  // an abstract address, which creates no file
  address.sun_family = AF_UNIX;
  std::ranges::copy(name, address.sun_path + 1);
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  const int socket_of_domain = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (bind(socket_of_domain, reinterpret_cast<sockaddr*>(&address), size) == 0) return true;
  close(socket_of_domain);
  return false;
}

/// Each test process uses its own DDS domain, so several tests can run at the same time.
inline const int own_domain = [] {
  for (int k = 0; k < 200; ++k) {
    const int id = 1 + (getpid() + k) % 200;
    if (!reserve_domain(id)) continue;
    setenv("ERP_DOMAIN", std::to_string(id).c_str(), 1);
    return id;
  }
  throw std::runtime_error("every DDS domain of the tests is in use: 200 tests are running");
}();
