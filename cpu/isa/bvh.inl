// Sixteen rays through the BVH together, compiled once per instruction set (see lanes.inl).
//
// The tube that holds them all (walk_tube.h) picks what of a node they may meet; each picked box is then held against
// the rays themselves, sixteen at once. Where few meet it they go on alone, so that rays which part cost no more than
// they would have alone. Source of the idea: Benthin, Wald, Woop, Ernst, "Combining Single and Packet-Ray Tracing for
// Arbitrary Ray Distributions on the Intel MIC Architecture" (2012).

#include "cpu/isa/bvh_single.inl"

namespace rayengine::ISA {
namespace {

constexpr int parts = group / reals_count;
constexpr unsigned part_bits = (1u << reals_count) - 1;
constexpr int few = 4;  // rays that are quicker alone

struct PacketState {
  LocalRays local;
  State<Reals> part[parts];
  unsigned hit = 0;  ///< a bit for each ray
};

/// A node or leaf that waits, and the box it was met by: a lane of its parent.
struct Waiting {
  std::uint64_t key;
  std::uint32_t parent, lane;
};

INLINE kernels::Mask<Reals> lanes_with(unsigned bits) {
  kernels::Mask<Reals> of_lane, all_bits;
  for (int i = 0; i < reals_count; ++i) of_lane[i] = 1ll << i, all_bits[i] = bits;
  return (all_bits & of_lane) != 0;
}

template <Ask ask>
INLINE void load_packet(const BvhJob& job, const Ray* rays, std::size_t count, const RayError& error, PacketState& p) {
  alignas(64) double column[8][group];
  for (std::size_t k = 0; k < group; ++k) {
    const auto* row = reinterpret_cast<const double*>(rays + (k < count ? k : 0));
    for (int i = 0; i < 7; ++i) column[i][k] = row[i];
    column[7][k] = ask.certain ? row[7] : just_above(row[7]);
  }
  for (int i = 0; i < parts; ++i) {
    State<Reals>& s = p.part[i];
    const auto at = [&](int c) { return read<Reals>(column[c] + i * reals_count); };
    s.rays.o = {at(0), at(1), at(2)};
    s.rays.d = {at(4), at(5), at(6)};
    s.rays.tmin = at(3), s.rays.nearest = at(7);
    begin(s);
    if (ask.certain) begin_certain(job, error, s);
  }
}

template <Ask ask>
INLINE State<double> extract(const State<Reals>& s, int i) {
  const auto vec = [i](const Vec3<Reals>& v) { return Vec3<double>{v.x[i], v.y[i], v.z[i]}; };
  const Sheared<Reals>& h = s.sheared;
  State<double> one{{vec(s.rays.o), vec(s.rays.d), s.rays.tmin[i], s.rays.nearest[i], s.rays.object[i], true},
                    {h.x_last[i] != 0, h.y_last[i] != 0, vec(h.shear), 0, 0, 0, 0},
                    s.index[i],
                    s.part[i],
                    s.u[i],
                    s.v[i],
                    {}};
  if (!ask.certain) return one;
  one.sheared.corner_error = h.corner_error[i];
  one.sheared.widest_error = h.widest_error[i];
  one.sheared.depth_error = h.depth_error[i];
  one.sheared.per_length = h.per_length[i];
  const Certainty<Reals>& c = s.certainty;
  one.certainty = {c.t[i], c.low[i], c.rival[i], c.o_extra[i], c.d_size[i]};
  return one;
}

template <Ask ask>
INLINE void put_back(const State<double>& from, State<Reals>& s, int i) {
  s.rays.nearest[i] = from.rays.nearest;
  s.rays.object[i] = from.rays.object;
  s.index[i] = from.index, s.part[i] = from.part, s.u[i] = from.u, s.v[i] = from.v;
  if (!ask.certain) return;
  const Certainty<double>& c = from.certainty;
  s.certainty.t[i] = c.t, s.certainty.low[i] = c.low, s.certainty.rival[i] = c.rival;
}

/// A ray that needs no more: no box reaches it.
INLINE void end_ray(PacketState& p, int k) { p.local.length[k] = -1; }

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

INLINE void load_local(const BvhJob& job, const Ray* rays, std::size_t count, LocalRays& local) {
  for (int place = 0; place < group; place += packet) {
    const std::size_t first = static_cast<std::size_t>(place) < count ? place : count - 1;
    to_local(job, rays + first, count - first, local, place);
  }
}

/// Leaves alive, of the first `count` rays of a group, those that reach the tree and are not done; a bit for each.
INLINE unsigned keep_alive(LocalRays& local, std::size_t count, unsigned done) {
  unsigned alive = 0;
  for (int k = 0; k < group; ++k) {
    local.alive[k] = static_cast<std::size_t>(k) < count && local.alive[k] && !(done >> k & 1);
    alive |= static_cast<unsigned>(local.alive[k]) << k;
  }
  return alive;
}

template <Ask ask>
INLINE void trace_group(const BvhJob& job, const Ray* rays, std::size_t count, const RayError& error, PacketState& p) {
  p.hit = 0;
  load_packet<ask>(job, rays, count, error, p);
  if (job.unbounded) test_leaf_together<ask>(job, *job.unbounded, p, (1u << count) - 1);
  if (!job.nodes) return;
  load_local(job, rays, count, p.local);
  const unsigned alive = keep_alive(p.local, count, ask.any ? p.hit : 0);
  Tube tube;
  const bool together = enclose(p.local, tube);  // gives places without a living ray the numbers of one
  for (int k = 0; k < group; ++k)
    if (!(alive >> k & 1)) end_ray(p, k);
  shorten_hit<ask>(job, p, p.hit & alive);
  if (together)
    trace_tube<ask>(job, p, tube);
  else
    trace_lanes<ask>(job, p, alive, 0);
}

INLINE std::size_t group_size(std::size_t left) { return left < group ? left : group; }

constexpr Ask nearest_hit{false, false}, any_hit{true, false}, certain_nearest{false, true}, certain_any{true, true};

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
INLINE void closest_hits(const BvhJob& job, const Ray* rays, std::size_t count, const RayError& error,
                         BvhAnswer* answers) {
  PacketState p;
  for (std::size_t first = 0; first < count; first += group) {
    trace_group<ask>(job, rays + first, group_size(count - first), error, p);
    for (std::size_t k = 0; k < group_size(count - first); ++k) {
      const State<Reals>& s = p.part[k / reals_count];
      answers[first + k] = ask.certain ? certain_answer_of(s, k % reals_count) : answer_of(s, k % reals_count);
    }
  }
}

template <Ask ask>
INLINE void any_hits(const BvhJob& job, const Ray* rays, std::size_t count, const RayError& error,
                     std::uint32_t* status) {
  PacketState p;
  for (std::size_t first = 0; first < count; first += group) {
    trace_group<ask>(job, rays + first, group_size(count - first), error, p);
    for (std::size_t k = 0; k < group_size(count - first); ++k) {
      const bool hit = p.hit >> k & 1;
      status[first + k] = hit ? status_hit : status_miss;
      if (ask.certain && !hit && is_unsure(p.part[k / reals_count], k % reals_count)) status[first + k] = status_unsure;
    }
  }
}

void closest(const BvhJob& job, const Ray* rays, std::size_t count, BvhAnswer* answers) {
  closest_hits<nearest_hit>(job, rays, count, {}, answers);
}
void any(const BvhJob& job, const Ray* rays, std::size_t count, std::uint32_t* status) {
  any_hits<any_hit>(job, rays, count, {}, status);
}
void certain_closest(const BvhJob& job, const Ray* rays, std::size_t count, const RayError& error, BvhAnswer* answers) {
  closest_hits<certain_nearest>(job, rays, count, error, answers);
}
void certainly_any(const BvhJob& job, const Ray* rays, std::size_t count, const RayError& error,
                   std::uint32_t* status) {
  any_hits<certain_any>(job, rays, count, error, status);
}

}  // namespace

constinit const BvhQueries bvh_queries{closest,          any,   all_hits, certain_closest, certainly_any,
                                       certain_all_hits, leaves};

}  // namespace rayengine::ISA
