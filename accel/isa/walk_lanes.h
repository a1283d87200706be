// Rays and trees over the eight lanes that the including file names. No include guard and no shared inline functions:
// each instruction set has its own copy, in its own namespace, that no linker can mistake for another's.

#include "accel/isa/walk_local.h"
#include "accel/isa/walk_tube.h"

/// 1 for what is negative; no branch, and no wait for a comparison.
static inline unsigned sign_bit(float a) {
  std::uint32_t bits;
  __builtin_memcpy(&bits, &a, sizeof bits);
  return bits >> 31;
}

/// One of LocalRays, ready to be tested against nodes.
struct LocalRay {
  lanes near_origin[3], far_origin[3], inverse[3], length;
  unsigned near_side[3];  ///< which plane of a slab is met first

  LocalRay(const LocalRays& rays, int k) : length(all(rays.length[k])) {
    for (int axis = 0; axis < 3; ++axis) {
      near_origin[axis] = all(rays.near_origin[axis][k]);
      far_origin[axis] = all(rays.far_origin[axis][k]);
      inverse[axis] = all(rays.inverse[axis][k]);
      near_side[axis] = sign_bit(rays.inverse[axis][k]);
    }
  }
};

/// What a ray meets of a node: a bit per lane, and where.
static inline unsigned meet(const WideNode& node, const LocalRay& ray, lanes after, lanes& enter) {
  enter = all(0);
  lanes leave = ray.length;
  for (int axis = 0; axis < 3; ++axis) {
    const float* near = node.planes[axis][ray.near_side[axis]];
    const float* far = node.planes[axis][ray.near_side[axis] ^ 1];
    enter = larger(multiply_subtract(load(near), ray.inverse[axis], ray.near_origin[axis]), enter);
    leave = smaller(multiply_subtract(load(far), ray.inverse[axis], ray.far_origin[axis]), leave);
  }
  return not_above(larger(enter, after), leave);
}

/// Orders what waits in the queue: by entry, then nodes before leaves, then by number. Entries are never negative.
static inline std::uint64_t key_of(float entry, std::uint32_t child) {
  std::uint32_t bits;
  __builtin_memcpy(&bits, &entry, sizeof bits);
  return static_cast<std::uint64_t>(bits) << 32 | child;
}
static inline float entry_of(std::uint64_t key) {
  const std::uint32_t bits = static_cast<std::uint32_t>(key >> 32);
  float entry;
  __builtin_memcpy(&entry, &bits, sizeof entry);
  return entry;
}
