#pragma once
#include <unistd.h>

#include <cstdlib>
#include <string>

/// Each test process uses its own DDS domain, so several tests can run at the same time.
inline const int own_domain = [] {
  const int id = 1 + getpid() % 200;
  setenv("ERP_DOMAIN", std::to_string(id).c_str(), 1);
  return id;
}();
