// Its own program: it replaces the allocator to count.
#include <catch2/catch.hpp>
#include <cstdlib>
#include <new>

#include "tests/sim/rigs.hpp"
#include "tests/sim/world/limb.hpp"

namespace {
std::size_t allocations = 0;
}

void* operator new(std::size_t n) {
  ++allocations;
  if (void* p = std::malloc(n)) return p;
  throw std::bad_alloc();
}
void* operator new(std::size_t n, const std::nothrow_t&) noexcept {
  ++allocations;
  return std::malloc(n);
}
void* operator new(std::size_t n, std::align_val_t a) {
  ++allocations;
  const auto align = static_cast<std::size_t>(a);
  if (void* p = std::aligned_alloc(align, (n + align - 1) / align * align)) return p;
  throw std::bad_alloc();
}
void operator delete(void* p) noexcept { std::free(p); }
void operator delete(void* p, std::size_t) noexcept { std::free(p); }
void operator delete(void* p, std::align_val_t) noexcept { std::free(p); }
void operator delete(void* p, std::size_t, std::align_val_t) noexcept { std::free(p); }

TEST_CASE("a tick of the arm, its ECUs and its frame does not touch the heap") {
  Limb limb(erp::read_robot(rigs::config("arm/robot.xml")));
  erp::EcuFrame frame;
  erp::JointState joints;
  erp::BodyPose bodies;
  const auto tick = [&] {
    limb.ecus.tick(limb.world);
    limb.ecus.fill(frame);
    limb.world.fill(joints);
    limb.world.fill(bodies);
  };
  for (int k = 0; k < 10; ++k) tick();
  const std::size_t before = allocations;
  for (int k = 0; k < 100; ++k) tick();
  const std::size_t after = allocations;
  CHECK(after == before);
}
