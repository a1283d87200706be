// What is known of rays on their way through a BVH, in lanes of double or for one ray, and how primitives change it.

#include "cpu/isa/bvh_job.h"
#include "cpu/isa/quadric_certainty.inl"

namespace rayengine::ISA {
namespace {

/// Bits of the lanes that a mask holds.
INLINE unsigned lanes_of(const kernels::Mask<Lanes<double>>& mask) { return bits_of(mask); }
INLINE unsigned lanes_of(bool mask) { return mask; }

/// What a query asks for, and whether its answers must be proven.
struct Ask {
  bool any, certain;
};

/// What the triangle kernel needs of a ray; the second line is for queries that certify (see uncertainty.glsl).
template <class REAL>
struct Sheared {
  kernels::Mask<REAL> x_last, y_last;
  Vec3<REAL> shear;
  REAL corner_error, widest_error, depth_error, per_length;
};

/// What queries that certify keep beside the nearest hit, which then ends at Rays::nearest.
template <class REAL>
struct Certainty {
  REAL t, low;   ///< of the nearest hit: its t, and what it is not before
  REAL rival;    ///< what no other hit is before
  REAL o_extra;  ///< the error of the ray's origin, in units that the bounds count in
  REAL d_size;   ///< bounds the components of its direction, and with them their error
};

/// Rays and the nearest hits of theirs so far. `rays.nearest` is just above tmax at first.
template <class REAL>
struct State {
  Rays<REAL> rays;
  Sheared<REAL> sheared;
  REAL index, part, u, v;  ///< as in BvhAnswer
  Certainty<REAL> certainty;
};

template <class REAL>
INLINE void begin(State<REAL>& s) {
  kernels::ray_shear(s.rays.d, s.sheared.x_last, s.sheared.y_last, s.sheared.shear);
  s.rays.object = s.index = REAL{};  // the lowest ids: nothing ties with the end of the interval
  s.u = s.v = REAL{};
  s.part = splat<REAL>(BvhAnswer::miss);
  s.sheared.corner_error = s.sheared.widest_error = s.sheared.depth_error = s.sheared.per_length = REAL{};
}

/// How far the corners of triangles are from a ray's origin, on any axis.
template <class REAL>
INLINE REAL reach(const BvhJob& job, const Vec3<REAL>& o) {
  const auto along = [&](int axis, REAL at) {
    return kernels::larger(splat<REAL>(job.corner_upper[axis]) - at, at - splat<REAL>(job.corner_lower[axis]));
  };
  return kernels::larger(kernels::larger(along(0, o.x), along(1, o.y)), along(2, o.z));
}

/// Keeps products of what is this small from underflowing unseen: smaller edge functions count as unsure.
constexpr double underflow = 0x1p-900;

/// By the errors of the origin and the direction.
template <class REAL>
INLINE void begin_certain(const BvhJob& job, REAL o_error, REAL d_error, State<REAL>& s) {
  constexpr double units = 6 * std::numeric_limits<double>::epsilon() / 2;
  const REAL none = splat<REAL>(std::numeric_limits<double>::infinity());
  Certainty<REAL>& c = s.certainty;
  c.t = c.low = c.rival = none;
  c.o_extra = o_error / units;
  const REAL length = largest_of(s.rays.d);
  c.d_size = length + d_error / units;
  const REAL far = reach(job, s.rays.o);
  s.sheared.per_length = 1 / length;
  s.sheared.corner_error = kernels::corner_error(far, o_error, 3 * d_error * s.sheared.per_length);
  s.sheared.widest_error = kernels::edge_error(3 * far, s.sheared.corner_error) + splat<REAL>(underflow);
  s.sheared.depth_error = kernels::depth_error(far, length, o_error, d_error);
}

/// Brings in what may be hit at t, off by `error` at most. What is hit for sure, and for sure before the nearest hit's
/// end, becomes the nearest; of whatever else may lie before that end the lowest t is kept. NaN is taken as anything.
/// The lanes that were hit for sure.
template <Ask ask, class REAL>
INLINE unsigned admit(State<REAL>& s, REAL t, REAL error, const kernels::Mask<REAL>& possible,
                      const kernels::Mask<REAL>& certain, REAL object, REAL index, REAL part, REAL u, REAL v) {
  Certainty<REAL>& c = s.certainty;
  const REAL low = t - error, high = t + error;
  const auto counts = kernels::both(possible, kernels::both(!(high <= s.rays.tmin), !(low > s.rays.nearest)));
  if (!lanes_of(counts)) return 0;
  const auto first =
      kernels::both(kernels::both(counts, certain), kernels::both(low > s.rays.tmin, high <= s.rays.nearest));
  const REAL least = splat<REAL>(-std::numeric_limits<double>::infinity());
  const REAL behind = kernels::pick(first, c.low, kernels::pick(low <= s.rays.nearest, low, least));
  c.rival = kernels::pick(counts, kernels::smaller(behind, c.rival), c.rival);
  if (ask.any) return lanes_of(first);
  s.rays.nearest = kernels::pick(first, high, s.rays.nearest);
  s.rays.object = kernels::pick(first, object, s.rays.object);
  c.t = kernels::pick(first, t, c.t);
  c.low = kernels::pick(first, low, c.low);
  s.index = kernels::pick(first, index, s.index);
  s.part = kernels::pick(first, part, s.part);
  s.u = kernels::pick(first, u, s.u);
  s.v = kernels::pick(first, v, s.v);
  return lanes_of(first);
}

/// The next double above t; infinity stays.
template <class REAL>
INLINE REAL just_above(REAL t) {
  using Bits = std::conditional_t<kernels::is_lanes<REAL>, kernels::Mask<REAL>, long long>;
  const Bits bits = read<Bits>(&t), one = Bits{} + 1;
  const Bits beyond_zero = t > 0 ? bits + one : bits - one;
  const Bits above = t == 0 ? one : beyond_zero;
  return t < __builtin_inf() ? read<REAL>(&above) : t;
}

template <int kind, class REAL>
void meet_quadric(const Geometry& geometry, const Quadric& quadric, const Rays<REAL>& rays, Found<REAL>& found) {
  found = intersect<kind>(geometry, quadric, rays);
}

template <class REAL>
using MeetQuadric = void (*)(const Geometry&, const Quadric&, const Rays<REAL>&, Found<REAL>&);

template <class REAL, int... kind>
constexpr auto meet_table(std::integer_sequence<int, kind...>) {
  struct Table {
    MeetQuadric<REAL> meet[sizeof...(kind)];
  };
  return Table{{meet_quadric<kind, REAL>...}};
}
template <class REAL>
constexpr auto meets = meet_table<REAL>(std::make_integer_sequence<int, quadric_kind_count>());

/// Tests one quadric of the leaf; the lanes that were hit nearer than before.
template <Ask ask, class REAL>
INLINE unsigned test_quadric(const BvhJob& job, std::uint32_t i, State<REAL>& s) {
  const Quadric& quadric = job.geometry->quadrics.data()[job.quadrics[i]];
  Found<REAL> found;
  meets<REAL>.meet[job.kinds[i]](*job.geometry, quadric, s.rays, found);
  const unsigned hit = lanes_of(found.hit);
  if (!hit || ask.any) return hit;
  s.rays.nearest = kernels::pick(found.hit, found.t, s.rays.nearest);
  s.rays.object = kernels::pick(found.hit, splat<REAL>(quadric.object), s.rays.object);
  s.index = kernels::pick(found.hit, splat<REAL>(job.quadrics[i]), s.index);
  s.part = kernels::pick(found.hit, found.part, s.part);
  return hit;
}

template <int kind, Ask ask, class REAL>
unsigned certify_quadric(const BvhJob& job, std::uint32_t i, State<REAL>& s) {
  const Quadric& quadric = job.geometry->quadrics.data()[job.quadrics[i]];
  unsigned hit = 0;
  const auto take = [&](REAL t, REAL error, const auto& possible, const auto& certain, double part) {
    hit |= admit<ask>(s, t, error, possible, certain, splat<REAL>(quadric.object), splat<REAL>(job.quadrics[i]),
                      splat<REAL>(part), REAL{}, REAL{});
  };
  certain_crossings<kind, false>(*job.geometry, quadric, job.norms[i], s.rays, s.certainty.o_extra, s.certainty.d_size,
                                 take);
  return hit;
}

template <Ask ask, class REAL, int... kind>
constexpr auto certify_table(std::integer_sequence<int, kind...>) {
  struct Table {
    unsigned (*certify[sizeof...(kind)])(const BvhJob&, std::uint32_t, State<REAL>&);
  };
  return Table{{certify_quadric<kind, ask, REAL>...}};
}
template <Ask ask, class REAL>
constexpr auto certifies = certify_table<ask, REAL>(std::make_integer_sequence<int, quadric_kind_count>());

template <Ask ask, class REAL>
INLINE unsigned test_quadrics(const BvhJob& job, const BvhLeaf& leaf, State<REAL>& s) {
  unsigned hit = 0;
  for (std::uint32_t i = leaf.first_quadric; i < leaf.first_quadric + leaf.quadric_count; ++i) {
    if constexpr (ask.certain)
      hit |= certifies<ask, REAL>.certify[job.kinds[i]](job, i, s);
    else
      hit |= test_quadric<ask>(job, i, s);
  }
  return hit;
}

template <class REAL>
struct Crossing {
  REAL t, u, v;
  kernels::Mask<REAL> hit;      ///< perhaps, where queries certify
  kernels::Mask<REAL> certain;  ///< of those alone, as is `error`
  REAL error;
};

/// Completes a crossing that may be one. Where the edge functions do not tell, it lies between the corners' depths.
template <class REAL>
INLINE void bound(const Sheared<REAL>& h, const Vec3<REAL>& w, const Vec3<REAL>& depth, REAL size, Crossing<REAL>& x) {
  const REAL edge_error = kernels::edge_error(size, h.corner_error) + splat<REAL>(underflow);
  x.hit = kernels::both(x.hit, kernels::one_sign(w, edge_error));
  x.certain = kernels::one_sign(w, -edge_error);
  x.error = kernels::crossing_error(w, depth, edge_error, h.per_length, h.depth_error);
  if (lanes_of(kernels::both(x.hit, !x.certain)) == 0) return;
  const REAL sign = kernels::pick(h.shear.z < 0, -h.per_length, h.per_length);
  const REAL least = kernels::smaller(kernels::smaller(depth.x, depth.y), depth.z);
  const REAL most = kernels::larger(kernels::larger(depth.x, depth.y), depth.z);
  x.t = kernels::pick(x.certain, x.t, (least + most) * sign / 2);
  x.error = kernels::pick(x.certain, x.error, (most - least) * h.per_length + h.depth_error);
}

/// Where rays cross triangles after tmin: in lanes are many rays, or many triangles.
template <Ask ask, class REAL>
INLINE Crossing<REAL> cross(const Vec3<REAL>& o, const Sheared<REAL>& sheared, const Vec3<REAL>& a, const Vec3<REAL>& b,
                            const Vec3<REAL>& c, REAL tmin, const kernels::Mask<REAL>& active) {
  Vec3<REAL> w, depth;
  REAL size;
  Crossing<REAL> x;
  kernels::triangle_edges(o, sheared.x_last, sheared.y_last, sheared.shear, a, b, c, w, depth, size);
  // At first by the bound for all triangles, which costs nothing: few are left for their own.
  x.hit = ask.certain ? kernels::one_sign(w, sheared.widest_error) : kernels::triangle_inside(w);
  x.hit = kernels::both(x.hit, active);
  if (!lanes_of(x.hit)) return x;
  kernels::triangle_crossing(sheared.shear, w, depth, x.t, x.u, x.v);
  if constexpr (ask.certain) {
    bound(sheared, w, depth, size, x);
    return x;
  }
  const REAL largest = splat<REAL>(std::numeric_limits<double>::max());
  x.hit = kernels::both(x.hit, kernels::both(x.t > tmin, x.t <= largest));
  return x;
}

/// Whether `x` is nearer than what is known, or as near and of lower ids. Indices of triangles are ordered by their
/// ids.
template <class REAL>
INLINE kernels::Mask<REAL> comes_first(const State<REAL>& s, const Crossing<REAL>& x, REAL object, REAL index) {
  const auto lower = kernels::either(object < s.rays.object, kernels::both(object == s.rays.object, index < s.index));
  return kernels::both(x.hit, kernels::either(x.t < s.rays.nearest, kernels::both(x.t == s.rays.nearest, lower)));
}

template <class REAL>
INLINE void take_crossing(State<REAL>& s, const Crossing<REAL>& x, const kernels::Mask<REAL>& nearer, REAL object,
                          REAL index) {
  s.rays.nearest = kernels::pick(nearer, x.t, s.rays.nearest);
  s.rays.object = kernels::pick(nearer, object, s.rays.object);
  s.index = kernels::pick(nearer, index, s.index);
  s.part = kernels::pick(nearer, splat<REAL>(BvhAnswer::triangle), s.part);
  s.u = kernels::pick(nearer, x.u, s.u);
  s.v = kernels::pick(nearer, x.v, s.v);
}

/// Among triangles indices say all, and what would be fetched from anywhere in memory is not.
INLINE std::uint32_t object_beside_quadrics(const Geometry& geometry, std::uint32_t triangle) {
  return geometry.quadrics.empty() ? 0 : geometry.triangle_object.data()[triangle];
}

/// Brings in a crossing with triangle `index`; the lanes that were hit nearer than before.
template <Ask ask, class REAL>
INLINE unsigned take(const BvhJob& job, State<REAL>& s, const Crossing<REAL>& x, std::uint32_t index) {
  const REAL object = splat<REAL>(object_beside_quadrics(*job.geometry, index)), id = splat<REAL>(index);
  if constexpr (ask.certain)
    return admit<ask>(s, x.t, x.error, x.hit, x.certain, object, id, splat<REAL>(BvhAnswer::triangle), x.u, x.v);
  const auto nearer = comes_first(s, x, object, id);
  if (!ask.any) take_crossing(s, x, nearer, object, id);
  return lanes_of(nearer);
}

template <class REAL, class T>
INLINE Vec3<REAL> corner(const TriangleBlock<T>& block, int corner, std::uint32_t place) {
  const auto& c = block.corners[corner];
  return {splat<REAL>(c[0][place]), splat<REAL>(c[1][place]), splat<REAL>(c[2][place])};
}

/// Rays in lanes against one triangle after the other.
template <Ask ask, class T, class REAL>
INLINE unsigned test_triangles(const BvhJob& job, const TriangleBlock<T>* blocks, std::uint32_t count, State<REAL>& s) {
  unsigned hit = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const TriangleBlock<T>& block = blocks[i / TriangleBlock<T>::width];
    const std::uint32_t place = i % TriangleBlock<T>::width;
    const Crossing<REAL> x =
        cross<ask>(s.rays.o, s.sheared, corner<REAL>(block, 0, place), corner<REAL>(block, 1, place),
                   corner<REAL>(block, 2, place), s.rays.tmin, s.rays.active);
    if (lanes_of(x.hit)) hit |= take<ask>(job, s, x, block.id[place]);
  }
  return hit;
}

template <Ask ask, class REAL>
INLINE unsigned test_leaf(const BvhJob& job, const BvhLeaf& leaf, State<REAL>& s) {
  unsigned hit = 0;
  if (leaf.quadric_count) hit = test_quadrics<ask>(job, leaf, s);
  if (!leaf.triangle_count) return hit;
  if (job.float_blocks)
    return hit | test_triangles<ask>(job, job.float_blocks + leaf.first_block, leaf.triangle_count, s);
  return hit | test_triangles<ask>(job, job.double_blocks + leaf.first_block, leaf.triangle_count, s);
}

}  // namespace
}  // namespace rayengine::ISA
