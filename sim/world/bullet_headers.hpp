#pragma once
// Bullet's headers cause warnings with our options. Only this file includes them, without warnings.
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#pragma GCC diagnostic ignored "-Wpedantic"
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wunused-parameter"
#include <BulletCollision/NarrowPhaseCollision/btGjkEpa2.h>
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <btBulletDynamicsCommon.h>
#pragma GCC diagnostic pop

#include <array>

#include "sim/model/skeleton/pose.hpp"

/// Vectors for Bullet.
namespace sim {

inline btVector3 bt(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
inline btVector3 bt(const std::array<double, 3>& v) { return {v[0], v[1], v[2]}; }

}  // namespace sim
