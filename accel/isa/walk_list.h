// The walk over the eight lanes that the including file names, see walk_lanes.h.

#include "accel/isa/walk_found.h"

/// Keeps the queue sorted, its least key last.
static inline std::uint64_t* insert(std::uint64_t* end, std::uint64_t key) {
  std::uint64_t* at = end;
  for (; at[-1] < key; --at) *at = at[-1];
  *at = key;
  return end + 1;
}

/// A ray of a group whose leaves are to be listed.
struct Listing {
  const WalkJob& job;
  const LocalRays& rays;
  int k;
  double tmin;
  WalkCursor& cursor;
  TreeletEntry* list;
  std::uint32_t count = 0;
};

/// Lists the leaf next in order; false when the list is full.
static inline bool append(Listing& to, std::uint64_t key) {
  const double t = (to.rays.t0[to.k] + entry_of(key)) * to.job.inverse_scale / to.rays.stride[to.k];
  to.list[to.count++] = {t > to.tmin ? t : to.tmin, static_cast<std::uint32_t>(key) ^ WideNode::leaf};
  to.cursor.last = key;
  return to.count < to.job.capacity;
}

/// Opens nodes in the order of the ray's way, and none behind the last leaf that is listed.
static inline void walk_in_order(Listing& to) {
  const std::uint64_t last = to.cursor.last;
  const LocalRay local(to.rays, to.k);
  const lanes after = all(entry_of(last));
  std::uint64_t* const begin = to.job.queue + 1;
  std::uint64_t* end = begin;
  begin[-1] = WalkCursor::end;  // above all keys: where an insertion stops
  *end++ = key_of(0, 0);
  while (end != begin) {
    const std::uint64_t key = *--end;
    const std::uint32_t child = static_cast<std::uint32_t>(key);
    if (child & WideNode::leaf) {
      if (key > last && !append(to, key)) return;
      continue;
    }
    const WideNode& node = to.job.nodes[child];
    lanes enter;
    unsigned met = meet(node, local, after, enter);
    alignas(32) float entries[WideNode::width];
    store(entries, enter);
    for (; met; met &= met - 1) {
      const int lane = __builtin_ctz(met);
      end = insert(end, key_of(entries[lane], node.children[lane]));
    }
  }
  to.cursor.last = WalkCursor::end;
}

/// The same with all leaves known.
static inline void list_found(const Found& found, Listing& to) {
  std::uint64_t* const begin = to.job.queue + 1;
  std::uint64_t* end = begin;
  begin[-1] = WalkCursor::end;
  for (int i = 0; i < found.count[to.k]; ++i) {
    const std::uint64_t key = key_of(found.entries[to.k][i], found.leaves[to.k][i]);
    if (key > to.cursor.last) end = insert(end, key);
  }
  while (end != begin)
    if (!append(to, *--end)) return;
  to.cursor.last = WalkCursor::end;
}

/// Finds what the chosen rays of a group meet; answers those that are left undone.
static inline unsigned find(const WideNode* nodes, LocalRays& rays, unsigned chosen, const float* after, Found& found) {
  Tube tube;
  if (enclose(rays, tube) && find_together(nodes, rays, tube, found)) return 0;
  return find_apart(nodes, rays, chosen, after, found);
}

static inline void load_local(const WalkJob& job, std::size_t first, std::size_t count, LocalRays& rays) {
  for (int place = 0; place < group; place += packet) {
    const std::size_t begin = static_cast<std::size_t>(place) < count ? place : count - 1;
    to_local(job, job.rays + first + begin, count - begin, rays, place);
  }
}

static inline void walk_group(const WalkJob& job, std::size_t first, std::size_t count) {
  LocalRays rays;
  load_local(job, first, count, rays);
  unsigned walking = 0;
  float after[group];
  for (std::size_t k = 0; k < count; ++k) {
    WalkCursor& cursor = job.cursors[first + k];
    after[k] = entry_of(cursor.last);
    if (!rays.alive[k]) cursor.last = WalkCursor::end;
    if (!cursor.finished()) walking |= 1u << k;
    job.counts[first + k] = 0;
  }
  if (!walking) return;
  Found found;
  const unsigned undone = find(job.nodes, rays, walking, after, found);
  for (; walking; walking &= walking - 1) {
    const int k = __builtin_ctz(walking);
    const std::size_t i = first + static_cast<std::size_t>(k);
    Listing listing{job, rays, k, job.rays[i].tmin, job.cursors[i], job.lists + i * job.capacity};
    if (undone >> k & 1 || found.is_full(k))
      walk_in_order(listing);
    else
      list_found(found, listing);
    job.counts[i] = listing.count;
  }
}

void walk(const WalkJob& job) {
  for (std::size_t first = 0; first < job.ray_count; first += group)
    walk_group(job, first, job.ray_count - first < group ? job.ray_count - first : group);
}
