// One ray through the BVH: eight boxes at a time, and as many triangles as there are lanes of double.

#include "cpu/isa/bvh_state.inl"

namespace rayengine::ISA {
#include "accel/isa/walk_lanes.h"

namespace {

using Reals = Lanes<double>;
constexpr int reals_count = lane_count<Reals>;
constexpr int most_waiting = 256 * WideNode::width;  // no binary tree of build_bvh is deeper

template <class T>
INLINE Reals load_reals(const T* from) {
  typedef T Part __attribute__((vector_size(sizeof(T) * reals_count)));
  return __builtin_convertvector(read<Part>(from), Reals);
}

template <class T>
INLINE Vec3<Reals> corners(const TriangleBlock<T>& block, int corner, std::uint32_t place) {
  const auto& c = block.corners[corner];
  return {load_reals(c[0] + place), load_reals(c[1] + place), load_reals(c[2] + place)};
}

INLINE kernels::Mask<Reals> mask_of(bool value) { return splat<Reals>(value ? 1 : 0) > 0; }

/// What one ray brings to triangles, in every lane.
INLINE Sheared<Reals> in_lanes(const Sheared<double>& h) {
  return {mask_of(h.x_last),
          mask_of(h.y_last),
          {splat<Reals>(h.shear.x), splat<Reals>(h.shear.y), splat<Reals>(h.shear.z)},
          splat<Reals>(h.corner_error),
          splat<Reals>(h.widest_error),
          splat<Reals>(h.depth_error),
          splat<Reals>(h.per_length)};
}

/// One ray against several triangles at once; then those that it crosses, of which there are few, one by one.
template <Ask ask, class T, class Take>
INLINE void cross_triangles(const TriangleBlock<T>* blocks, std::uint32_t count, const State<double>& s, Take&& take) {
  const Vec3<double>& o = s.rays.o;
  const Vec3<Reals> from{splat<Reals>(o.x), splat<Reals>(o.y), splat<Reals>(o.z)};
  const Sheared<Reals> sheared = in_lanes(s.sheared);
  for (std::uint32_t i = 0; i < count; i += reals_count) {
    const TriangleBlock<T>& block = blocks[i / TriangleBlock<T>::width];
    const std::uint32_t place = i % TriangleBlock<T>::width;
    const Crossing<Reals> x = cross<ask>(from, sheared, corners(block, 0, place), corners(block, 1, place),
                                         corners(block, 2, place), splat<Reals>(s.rays.tmin), mask_of(true));
    for (unsigned hit = lanes_of(x.hit); hit; hit &= hit - 1) {
      const int lane = __builtin_ctz(hit);
      Crossing<double> one{x.t[lane], x.u[lane], x.v[lane], true, true, 0};
      if (ask.certain) one.certain = x.certain[lane] != 0, one.error = x.error[lane];
      take(one, block.id[place + static_cast<unsigned>(lane)]);
    }
  }
}

template <Ask ask, class T>
INLINE bool test_triangles_alone(const BvhJob& job, const TriangleBlock<T>* blocks, std::uint32_t count,
                                 State<double>& s) {
  bool hit = false;
  cross_triangles<ask>(blocks, count, s,
                       [&](const Crossing<double>& x, std::uint32_t id) { hit |= take<ask>(job, s, x, id) != 0; });
  return hit;
}

template <Ask ask>
INLINE bool test_leaf_alone(const BvhJob& job, const BvhLeaf& leaf, State<double>& s) {
  bool hit = false;
  if (leaf.quadric_count) hit = test_quadrics<ask>(job, leaf, s);
  if (!leaf.triangle_count) return hit;
  if (job.float_blocks)
    return test_triangles_alone<ask>(job, job.float_blocks + leaf.first_block, leaf.triangle_count, s) || hit;
  return test_triangles_alone<ask>(job, job.double_blocks + leaf.first_block, leaf.triangle_count, s) || hit;
}

/// Brings the end of ray k of a group to a hit at t, rounded up by what placing the ray in the local frame may err.
INLINE void shorten(const BvhJob& job, LocalRays& local, int k, double t) {
  const double length = (t * job.scale * local.stride[k] - local.t0[k]) * (1 + 0x1p-20) + local.slack[k];
  if (length < local.length[k]) local.length[k] = static_cast<float>(length);
}

/// Puts a node's children that the ray meets on the stack, the nearest on top.
INLINE std::uint64_t* push_children(const WideNode& node, const LocalRay& ray, std::uint64_t* top) {
  lanes enter;
  unsigned met = meet(node, ray, all(0), enter);
  alignas(32) float entries[WideNode::width];
  store(entries, enter);
  std::uint64_t* const bottom = top;
  for (; met; met &= met - 1) {
    const int lane = __builtin_ctz(met);
    const std::uint64_t key = key_of(entries[lane], node.children[lane]);
    std::uint64_t* at = top++;
    for (; at != bottom && at[-1] < key; --at) *at = at[-1];
    *at = key;
  }
  return top;
}

/// Traces ray k of a group from `child` on. `at_leaf` answers whether the ray may end there.
template <class AtLeaf>
INLINE void descend(const BvhJob& job, LocalRays& local, int k, std::uint32_t child, AtLeaf&& at_leaf) {
  std::uint64_t stack[most_waiting];
  stack[0] = key_of(0, child);
  LocalRay ray(local, k);
  for (std::uint64_t* top = stack + 1; top != stack;) {
    const std::uint64_t key = *--top;
    if (entry_of(key) > local.length[k]) continue;
    const std::uint32_t next = static_cast<std::uint32_t>(key);
    if (!(next & WideNode::leaf)) {
      top = push_children(job.nodes[next], ray, top);
    } else {
      if (at_leaf(job.leaves[next ^ WideNode::leaf])) return;
      ray.length = ISA::all(local.length[k]);
    }
  }
}

/// The same in any order, for who wants any leaf: nothing is sorted, and nothing waits for what was met last.
template <class AtLeaf>
INLINE void descend_anyhow(const BvhJob& job, const LocalRays& local, int k, std::uint32_t child, AtLeaf&& at_leaf) {
  std::uint32_t stack[most_waiting + WideNode::width];  // store_chosen writes eight
  stack[0] = child;
  const LocalRay ray(local, k);
  for (std::uint32_t* top = stack + 1; top != stack;) {
    const std::uint32_t next = *--top;
    if (next & WideNode::leaf) {
      if (at_leaf(job.leaves[next ^ WideNode::leaf])) return;
      continue;
    }
    const WideNode& node = job.nodes[next];
    lanes enter;
    const unsigned met = meet(node, ray, all(0), enter);
    top += store_chosen(top, load_words(node.children), met);
  }
}

/// Whether the ray was hit nearer than before.
template <Ask ask>
bool trace_alone(const BvhJob& job, LocalRays& local, int k, std::uint32_t child, State<double>& s) {
  bool hit = false;
  const auto test = [&](const BvhLeaf& leaf) {
    if (!test_leaf_alone<ask>(job, leaf, s)) return false;
    hit = true;
    if (!ask.any) shorten(job, local, k, s.rays.nearest);
    return ask.any;
  };
  if constexpr (ask.any)
    descend_anyhow(job, local, k, child, test);
  else
    descend(job, local, k, child, test);
  return hit;
}

/// The bound that goes with t when the exact one lies in [low, high].
INLINE double stated_error(double t, double low, double high) {
  const double before = t - low, after = high - t;
  return (before > after ? before : after) + std::numeric_limits<double>::epsilon() / 2 * size_of(t);
}

/// Reports what may be hit within the interval: as unsure where the primitive may be missed, not where t may lie
/// outside.
INLINE void collect_possible(const State<double>& s, BvhAnswer answer, bool certain, CollectAnswer collect, void* to) {
  const double low = answer.t - answer.error, high = answer.t + answer.error;
  if (high <= s.rays.tmin || low > s.rays.nearest) return;
  answer.error = stated_error(answer.t, low, high);
  answer.unsure = !certain;
  collect(to, answer);
}

template <Ask ask, class T>
INLINE void collect_triangles(const TriangleBlock<T>* blocks, std::uint32_t count, const State<double>& s,
                              CollectAnswer collect, void* to) {
  cross_triangles<ask>(blocks, count, s, [&](const Crossing<double>& x, std::uint32_t id) {
    const BvhAnswer answer{x.t, x.error, id, BvhAnswer::triangle, static_cast<float>(x.u), static_cast<float>(x.v)};
    if (ask.certain)
      collect_possible(s, answer, x.certain, collect, to);
    else if (x.t < s.rays.nearest)
      collect(to, answer);
  });
}

template <int kind>
void all_crossings(const Geometry& geometry, const Quadric& quadric, const Rays<double>& rays,
                   Crossings<double>& found) {
  found = crossings<kind>(geometry, quadric, rays);
}
template <int... kind>
INLINE void cross_quadric(int which, const Geometry& geometry, const Quadric& quadric, const Rays<double>& rays,
                          Crossings<double>& found, std::integer_sequence<int, kind...>) {
  ((which == kind ? all_crossings<kind>(geometry, quadric, rays, found) : void()), ...);
}

INLINE void collect_quadrics(const BvhJob& job, const BvhLeaf& leaf, const State<double>& s, CollectAnswer collect,
                             void* to) {
  for (std::uint32_t i = leaf.first_quadric; i < leaf.first_quadric + leaf.quadric_count; ++i) {
    Crossings<double> c;
    cross_quadric(job.kinds[i], *job.geometry, job.geometry->quadrics.data()[job.quadrics[i]], s.rays, c,
                  std::make_integer_sequence<int, quadric_kind_count>());
    const double t[4] = {c.near, c.far, c.lower_cap, c.upper_cap};
    for (std::uint32_t k = 0; k < 4; ++k)
      if (t[k] > s.rays.tmin && t[k] < s.rays.nearest && t[k] < std::numeric_limits<double>::max())
        collect(to, {t[k], 0, job.quadrics[i], k < 2 ? 0 : k - 1, 0, 0});
  }
}

template <int kind>
void certify_all(const BvhJob& job, std::uint32_t i, const State<double>& s, CollectAnswer collect, void* to) {
  const Quadric& quadric = job.geometry->quadrics.data()[job.quadrics[i]];
  const auto take = [&](double t, double error, bool possible, bool certain, double part) {
    if (possible)
      collect_possible(s, {t, error, job.quadrics[i], static_cast<std::uint32_t>(part), 0, 0}, certain, collect, to);
  };
  certain_crossings<kind, true>(*job.geometry, quadric, job.norms[i], s.rays, s.certainty.o_extra, s.certainty.d_size,
                                take);
}
template <int... kind>
INLINE void certify_all(int which, const BvhJob& job, std::uint32_t i, const State<double>& s, CollectAnswer collect,
                        void* to, std::integer_sequence<int, kind...>) {
  ((which == kind ? certify_all<kind>(job, i, s, collect, to) : void()), ...);
}

template <Ask ask>
INLINE void collect_leaf(const BvhJob& job, const BvhLeaf& leaf, const State<double>& s, CollectAnswer collect,
                         void* to) {
  if constexpr (ask.certain) {
    for (std::uint32_t i = leaf.first_quadric; i < leaf.first_quadric + leaf.quadric_count; ++i)
      certify_all(job.kinds[i], job, i, s, collect, to, std::make_integer_sequence<int, quadric_kind_count>());
  } else {
    collect_quadrics(job, leaf, s, collect, to);
  }
  if (job.float_blocks)
    collect_triangles<ask>(job.float_blocks + leaf.first_block, leaf.triangle_count, s, collect, to);
  if (job.double_blocks)
    collect_triangles<ask>(job.double_blocks + leaf.first_block, leaf.triangle_count, s, collect, to);
}

INLINE State<double> begin_alone(const Ray& ray) {
  State<double> s;
  const auto& [o, tmin, d, tmax] = ray;
  s.rays.o = {o.x, o.y, o.z};
  s.rays.d = {d.x, d.y, d.z};
  s.rays.tmin = tmin, s.rays.nearest = just_above(tmax);
  s.rays.active = true;
  begin(s);
  return s;
}

/// Calls at_leaf(leaf) for all that the ray may meet, those without a box first, until it answers true.
template <class AtLeaf>
INLINE void for_leaves(const BvhJob& job, const Ray& ray, LocalRays& local, AtLeaf&& at_leaf) {
  if (job.unbounded && at_leaf(*job.unbounded)) return;
  if (!job.nodes) return;
  to_local(job, &ray, 1, local, 0);
  if (local.alive[0]) descend(job, local, 0, 0, at_leaf);
}

void all_hits(const BvhJob& job, const Ray& ray, CollectAnswer collect, void* to) {
  const State<double> s = begin_alone(ray);
  LocalRays local;
  for_leaves(job, ray, local, [&](const BvhLeaf& leaf) {
    collect_leaf<Ask{false, false}>(job, leaf, s, collect, to);
    return false;
  });
}

void certain_all_hits(const BvhJob& job, const Ray& ray, const RayError& error, CollectAnswer collect, void* to) {
  State<double> s = begin_alone(ray);
  s.rays.nearest = ray.tmax;
  begin_certain(job, error.origin, error.direction, s);
  LocalRays local;
  for_leaves(job, ray, local, [&](const BvhLeaf& leaf) {
    collect_leaf<Ask{false, true}>(job, leaf, s, collect, to);
    return false;
  });
}

void leaves(const BvhJob& job, const Ray& ray, TakeLeaf take, void* to) {
  if (!job.nodes) return;
  LocalRays local;
  to_local(job, &ray, 1, local, 0);
  if (!local.alive[0]) return;
  descend(job, local, 0, 0, [&](const BvhLeaf& leaf) {
    shorten(job, local, 0, take(to, leaf));
    return false;
  });
}

}  // namespace
}  // namespace rayengine::ISA
