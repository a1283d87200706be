// The walk over the eight lanes that the including file names. No include guard and no shared inline functions: each
// instruction set has its own copy, in its own namespace, that no linker can mistake for another's.

#include "accel/isa/walk_local.h"
#include "accel/isa/walk_tube.h"

/// One of LocalRays, ready to be tested against nodes.
struct LocalRay {
  lanes near_origin[3], far_origin[3], inverse[3], length;
  unsigned near_side[3];  ///< which plane of a slab is met first

  LocalRay(const LocalRays& rays, int k) : length(all(rays.length[k])) {
    for (int axis = 0; axis < 3; ++axis) {
      near_origin[axis] = all(rays.near_origin[axis][k]);
      far_origin[axis] = all(rays.far_origin[axis][k]);
      inverse[axis] = all(rays.inverse[axis][k]);
      near_side[axis] = rays.inverse[axis][k] < 0;
    }
  }
};

/// What a ray meets of a node: a bit per lane, and where.
static inline unsigned meet(const WideNode& node, const LocalRay& ray, lanes after, float* entries) {
  lanes enter = all(0), leave = ray.length;
  for (int axis = 0; axis < 3; ++axis) {
    const float* near = node.planes[axis][ray.near_side[axis]];
    const float* far = node.planes[axis][1 - ray.near_side[axis]];
    enter = larger(multiply_subtract(load(near), ray.inverse[axis], ray.near_origin[axis]), enter);
    leave = smaller(multiply_subtract(load(far), ray.inverse[axis], ray.far_origin[axis]), leave);
  }
  store(entries, enter);
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

/// Keeps the queue sorted, its least key last.
static inline std::uint64_t* insert(std::uint64_t* end, std::uint64_t key) {
  std::uint64_t* at = end;
  for (; at[-1] < key; --at) *at = at[-1];
  *at = key;
  return end + 1;
}

/// Where walks begin: at the first `count` of `nodes`.
struct Roots {
  const WideNode* nodes;
  std::uint32_t count;
};

/// Lists the next leaves of ray k of a group; moves its cursor.
static inline std::uint32_t walk_one(const WalkJob& job, const Roots& roots, const LocalRays& rays, int k, double tmin,
                                     WalkCursor& cursor, TreeletEntry* list) {
  std::uint32_t count = 0;
  const std::uint64_t last = cursor.last;
  const LocalRay local(rays, k);
  const lanes after = all(entry_of(last));
  job.queue[0] = WalkCursor::end;  // above all keys: where an insertion stops
  std::uint64_t* const begin = job.queue + 1;
  std::uint64_t* end = begin;
  for (std::uint32_t root = roots.count; root-- > 0;) *end++ = key_of(0, root);
  while (end != begin) {
    const std::uint64_t key = *--end;
    const std::uint32_t child = static_cast<std::uint32_t>(key);
    if (child & WideNode::leaf) {
      if (key <= last) continue;
      const double t = (rays.t0[k] + entry_of(key)) * job.inverse_scale / rays.stride[k];
      list[count++] = {t > tmin ? t : tmin, child ^ WideNode::leaf};
      cursor.last = key;
      if (count == job.capacity) return count;
      continue;
    }
    const WideNode& node = roots.nodes[child];
    alignas(32) float entries[WideNode::width];
    for (unsigned met = meet(node, local, after, entries); met; met &= met - 1) {
      const int lane = __builtin_ctz(met);
      end = insert(end, key_of(entries[lane], node.children[lane]));
    }
  }
  cursor.last = WalkCursor::end;
  return count;
}

static inline void walk_group(const WalkJob& job, std::size_t first, std::size_t count) {
  LocalRays local;
  for (int place = 0; place < group; place += packet) {
    const std::size_t begin = static_cast<std::size_t>(place) < count ? place : count - 1;
    to_local(job, job.rays + first + begin, count - begin, local, place);
  }
  WideNode found[found_nodes];
  Roots roots{job.nodes, 1};
  Tube tube;
  if (count == group && enclose(local, tube)) {
    const int leaves = find_leaves(job.nodes, tube, found);
    if (leaves >= 0) roots = {found, static_cast<std::uint32_t>(leaves + WideNode::width - 1) / WideNode::width};
  }
  for (std::size_t k = 0; k < count; ++k) {
    const std::size_t i = first + k;
    WalkCursor& cursor = job.cursors[i];
    job.counts[i] = 0;
    if (cursor.finished() || !local.alive[k])
      cursor.last = WalkCursor::end;
    else
      job.counts[i] =
          walk_one(job, roots, local, static_cast<int>(k), job.rays[i].tmin, cursor, job.lists + i * job.capacity);
  }
}

void walk(const WalkJob& job) {
  for (std::size_t first = 0; first < job.ray_count; first += group)
    walk_group(job, first, job.ray_count - first < group ? job.ray_count - first : group);
}
