#pragma once
#include <array>

#include "sim/model/skeleton/pose.hpp"
#include "sim/world/bullet_headers.hpp"

namespace sim {

inline btVector3 bt(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
inline btVector3 bt(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

}  // namespace sim
