#pragma once
#include <unistd.h>

#include <cstdlib>
#include <string>

/// Tests have a DDS domain of their own, by process, so that several may run side by side.
inline const int own_domain = [] {
  const int id = 1 + getpid() % 200;
  setenv("ERP_DOMAIN", std::to_string(id).c_str(), 1);
  return id;
}();
