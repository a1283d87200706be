// Sixteen rays through the BVH together, compiled once per instruction set (see lanes.inl).
//
// The tube that holds them all (walk_tube.h) picks what of a node they may meet; each picked box is then held against
// the rays themselves, sixteen at once. Where few meet it they go on alone, so that rays which part cost no more than
// they would have alone. Source of the idea: Benthin, Wald, Woop, Ernst, "Combining Single and Packet-Ray Tracing for
// Arbitrary Ray Distributions on the Intel MIC Architecture" (2012).

#include "cpu/isa/bvh_packet.inl"

namespace rayengine::ISA {
namespace {

constexpr int few = 4;  // rays that are quicker alone

/// A node or leaf that waits, and the box it was met by: a lane of its parent.
struct Waiting {
  std::uint64_t key;
  std::uint32_t parent, lane;
};

template <Ask ask>
INLINE void trace_lane(const BvhJob& job, PacketState& p, int k, std::uint32_t child) {
  State<Reals>& s = p.part[k / reals_count];
  State<double> alone = extract<ask>(s, k % reals_count);
  const bool hit = trace_alone<ask>(job, p.local, k, child, alone);
  if (hit) p.hit |= 1u << k;
  if (hit && ask.any)
    end_ray(p, k);
  else if (hit || ask.certain)
    put_back<ask>(alone, s, k % reals_count);
}

template <Ask ask>
INLINE void trace_lanes(const BvhJob& job, PacketState& p, unsigned rays, std::uint32_t child) {
  for (; rays; rays &= rays - 1) trace_lane<ask>(job, p, __builtin_ctz(rays), child);
}

/// Tests a leaf against the given rays; those that were hit nearer than before.
template <Ask ask>
INLINE unsigned test_leaf_together(const BvhJob& job, const BvhLeaf& leaf, PacketState& p, unsigned rays) {
  unsigned hit = 0;
  for (int i = 0; i < parts; ++i) {
    const unsigned mine = rays >> (i * reals_count) & part_bits;
    if (!mine) continue;
    p.part[i].rays.active = lanes_with(mine);
    hit |= test_leaf<ask>(job, leaf, p.part[i]) << (i * reals_count);
  }
  p.hit |= hit;
  return hit;
}

template <Ask ask>
INLINE void shorten_hit(const BvhJob& job, PacketState& p, unsigned hit) {
  for (; hit; hit &= hit - 1) {
    const int k = __builtin_ctz(hit);
    if (ask.any)
      end_ray(p, k);
    else
      shorten(job, p.local, k, p.part[k / reals_count].rays.nearest[k % reals_count]);
  }
}

INLINE float longest(const LocalRays& rays) { return interval(rays.length).upper; }

INLINE Waiting* push_children(const BvhJob& job, std::uint32_t parent, const Tube& tube, Waiting* top) {
  const WideNode& node = job.nodes[parent];
  lanes enter;
  unsigned met = meet(node, tube, enter);
  alignas(32) float entries[WideNode::width];
  store(entries, enter);
  Waiting* const bottom = top;
  for (; met; met &= met - 1) {
    const auto lane = static_cast<std::uint32_t>(__builtin_ctz(met));
    const Waiting child{key_of(entries[lane], node.children[lane]), parent, lane};
    Waiting* at = top++;
    for (; at != bottom && at[-1].key < child.key; --at) *at = at[-1];
    *at = child;
  }
  return top;
}

template <Ask ask>
INLINE void trace_tube(const BvhJob& job, PacketState& p, Tube& tube) {
  Waiting stack[most_waiting];
  float end = longest(p.local);
  for (Waiting* top = push_children(job, 0, tube, stack); top != stack;) {
    const Waiting now = *--top;
    if (entry_of(now.key) > end) continue;
    alignas(32) float entries[group];
    const unsigned rays = meet_box(job.nodes[now.parent], now.lane, p.local, tube, entries);
    if (!rays) continue;
    const auto child = static_cast<std::uint32_t>(now.key);
    const bool leaf = child & WideNode::leaf;
    if (!leaf && __builtin_popcount(rays) > few) {
      top = push_children(job, child, tube, top);
      continue;
    }
    const unsigned before = p.hit;
    if (leaf)
      shorten_hit<ask>(job, p, test_leaf_together<ask>(job, job.leaves[child ^ WideNode::leaf], p, rays));
    else
      trace_lanes<ask>(job, p, rays, child);
    if (ask.any && p.hit == before) continue;
    end = longest(p.local);
    if (end < 0) return;
    tube.length = ISA::all(end);
  }
}

/// Whether there was anything to meet; where not, nothing but `hit` is set.
template <Ask ask>
INLINE bool trace_group(const BvhJob& job, const Ray* rays, std::size_t count, const RayError* errors, PacketState& p) {
  Columns columns;
  load_columns(rays, count, columns);
  p.hit = 0;
  unsigned alive = 0;
  if (job.nodes) {
    load_local(job, columns, p.local);
    alive = living(p.local, count);
  }
  if (!alive && !job.unbounded) return false;
  load_packet<ask>(job, columns, errors, count, p);
  if (job.unbounded) test_leaf_together<ask>(job, *job.unbounded, p, (1u << count) - 1);
  if (ask.any) alive &= ~p.hit;
  if (!alive) return true;
  keep_alive(p.local, alive);
  Tube tube;
  const bool together = enclose(p.local, tube);  // gives places without a living ray the numbers of one
  for (int k = 0; k < group; ++k)
    if (!(alive >> k & 1)) end_ray(p, k);
  shorten_hit<ask>(job, p, p.hit & alive);
  if (together)
    trace_tube<ask>(job, p, tube);
  else
    trace_lanes<ask>(job, p, alive, 0);
  return true;
}

INLINE std::size_t group_size(std::size_t left) { return left < group ? left : group; }

constexpr Ask nearest_hit{false, false}, any_hit{true, false}, certain_nearest{false, true}, certain_any{true, true};

constexpr BvhAnswer no_answer{std::numeric_limits<double>::infinity(), 0, 0, BvhAnswer::miss, 0, 0};

INLINE BvhAnswer answer_of(const State<Reals>& s, std::size_t i) {
  return {s.rays.nearest[i],
          0,
          static_cast<std::uint32_t>(s.index[i]),
          static_cast<std::uint32_t>(s.part[i]),
          static_cast<float>(s.u[i]),
          static_cast<float>(s.v[i])};
}

INLINE bool is_unsure(const State<Reals>& s, std::size_t i) {
  const double rival = s.certainty.rival[i];
  return rival <= s.rays.nearest[i] && rival < std::numeric_limits<double>::infinity();
}

INLINE BvhAnswer certain_answer_of(const State<Reals>& s, std::size_t i) {
  BvhAnswer answer = answer_of(s, i);
  answer.t = s.certainty.t[i];
  answer.error = stated_error(answer.t, s.certainty.low[i], s.rays.nearest[i]);
  answer.unsure = is_unsure(s, i);
  return answer;
}

template <Ask ask>
INLINE void closest_hits(const BvhJob& job, const Ray* rays, std::size_t count, const RayError* errors,
                         BvhAnswer* answers) {
  PacketState p;
  for (std::size_t first = 0; first < count; first += group) {
    const std::size_t rays_here = group_size(count - first);
    const bool met = trace_group<ask>(job, rays + first, rays_here, errors ? errors + first : nullptr, p);
    for (std::size_t k = 0; k < rays_here; ++k) {
      const State<Reals>& s = p.part[k / reals_count];
      answers[first + k] = !met          ? no_answer
                           : ask.certain ? certain_answer_of(s, k % reals_count)
                                         : answer_of(s, k % reals_count);
    }
  }
}

template <Ask ask>
INLINE void any_hits(const BvhJob& job, const Ray* rays, std::size_t count, const RayError* errors,
                     std::uint32_t* status) {
  PacketState p;
  for (std::size_t first = 0; first < count; first += group) {
    const std::size_t rays_here = group_size(count - first);
    const bool met = trace_group<ask>(job, rays + first, rays_here, errors ? errors + first : nullptr, p);
    for (std::size_t k = 0; k < rays_here; ++k) {
      const bool hit = p.hit >> k & 1;
      status[first + k] = hit ? status_hit : status_miss;
      if (ask.certain && met && !hit && is_unsure(p.part[k / reals_count], k % reals_count))
        status[first + k] = status_unsure;
    }
  }
}

void closest(const BvhJob& job, const Ray* rays, std::size_t count, BvhAnswer* answers) {
  closest_hits<nearest_hit>(job, rays, count, nullptr, answers);
}
void any(const BvhJob& job, const Ray* rays, std::size_t count, std::uint32_t* status) {
  any_hits<any_hit>(job, rays, count, nullptr, status);
}
void certain_closest(const BvhJob& job, const Ray* rays, std::size_t count, const RayError* errors,
                     BvhAnswer* answers) {
  closest_hits<certain_nearest>(job, rays, count, errors, answers);
}
void certainly_any(const BvhJob& job, const Ray* rays, std::size_t count, const RayError* errors,
                   std::uint32_t* status) {
  any_hits<certain_any>(job, rays, count, errors, status);
}

}  // namespace

constinit const BvhQueries bvh_queries{closest,          any,   all_hits, certain_closest, certainly_any,
                                       certain_all_hits, leaves};

}  // namespace rayengine::ISA
