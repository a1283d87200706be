// What is known of rays on their way through a BVH, in lanes of double or for one ray, and how primitives change it.

#include "cpu/isa/bvh_job.h"
#include "cpu/isa/quadric_lanes.inl"

namespace rayengine::ISA {
namespace {

/// What the triangle kernel needs of a ray.
template <class REAL>
struct Sheared {
  kernels::Mask<REAL> x_last, y_last;
  Vec3<REAL> shear;
};

/// Rays and the nearest hits of theirs so far. `rays.nearest` is just above tmax at first.
template <class REAL>
struct State {
  Rays<REAL> rays;
  Sheared<REAL> sheared;
  REAL index, part, u, v;  ///< as in BvhAnswer
};

template <class REAL>
INLINE void begin(State<REAL>& s) {
  kernels::ray_shear(s.rays.d, s.sheared.x_last, s.sheared.y_last, s.sheared.shear);
  s.rays.object = s.index = REAL{};  // the lowest ids: nothing ties with the end of the interval
  s.u = s.v = REAL{};
  s.part = splat<REAL>(BvhAnswer::miss);
}

/// The next double above t; infinity stays.
INLINE double just_above(double t) {
  long long bits;
  __builtin_memcpy(&bits, &t, sizeof t);
  bits = t > 0 ? bits + 1 : t == 0 ? 1 : bits - 1;
  double above;
  __builtin_memcpy(&above, &bits, sizeof above);
  return t < __builtin_inf() ? above : t;
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

/// Bits of the lanes that a mask holds.
INLINE unsigned lanes_of(const kernels::Mask<Lanes<double>>& mask) { return bits_of(mask); }
INLINE unsigned lanes_of(bool mask) { return mask; }

/// Tests the leaf's quadrics; the lanes that were hit nearer than before.
template <bool any, class REAL>
INLINE unsigned test_quadrics(const BvhJob& job, const BvhLeaf& leaf, State<REAL>& s) {
  unsigned hit = 0;
  for (std::uint32_t i = leaf.first_quadric; i < leaf.first_quadric + leaf.quadric_count; ++i) {
    const Quadric& quadric = job.geometry->quadrics.data()[job.quadrics[i]];
    Found<REAL> found;
    meets<REAL>.meet[job.kinds[i]](*job.geometry, quadric, s.rays, found);
    const unsigned now = lanes_of(found.hit);
    if (!now) continue;
    hit |= now;
    if (any) continue;
    s.rays.nearest = kernels::pick(found.hit, found.t, s.rays.nearest);
    s.rays.object = kernels::pick(found.hit, splat<REAL>(quadric.object), s.rays.object);
    s.index = kernels::pick(found.hit, splat<REAL>(job.quadrics[i]), s.index);
    s.part = kernels::pick(found.hit, found.part, s.part);
  }
  return hit;
}

template <class REAL>
struct Crossing {
  REAL t, u, v;
  kernels::Mask<REAL> hit;
};

/// Where rays cross triangles after tmin: in lanes are many rays, or many triangles.
template <class REAL>
INLINE Crossing<REAL> cross(const Vec3<REAL>& o, const Sheared<REAL>& sheared, const Vec3<REAL>& a, const Vec3<REAL>& b,
                            const Vec3<REAL>& c, REAL tmin, const kernels::Mask<REAL>& active) {
  Vec3<REAL> w, depth;
  Crossing<REAL> x;
  kernels::triangle_edges(o, sheared.x_last, sheared.y_last, sheared.shear, a, b, c, w, depth, x.hit);
  x.hit = kernels::both(x.hit, active);
  if (!lanes_of(x.hit)) return x;
  kernels::triangle_crossing(sheared.shear, w, depth, x.t, x.u, x.v);
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
INLINE void take(State<REAL>& s, const Crossing<REAL>& x, const kernels::Mask<REAL>& nearer, REAL object, REAL index) {
  s.rays.nearest = kernels::pick(nearer, x.t, s.rays.nearest);
  s.rays.object = kernels::pick(nearer, object, s.rays.object);
  s.index = kernels::pick(nearer, index, s.index);
  s.part = kernels::pick(nearer, splat<REAL>(BvhAnswer::triangle), s.part);
  s.u = kernels::pick(nearer, x.u, s.u);
  s.v = kernels::pick(nearer, x.v, s.v);
}

template <class REAL, class T>
INLINE Vec3<REAL> corner(const TriangleBlock<T>& block, int corner, std::uint32_t place) {
  const auto& c = block.corners[corner];
  return {splat<REAL>(c[0][place]), splat<REAL>(c[1][place]), splat<REAL>(c[2][place])};
}

/// Rays in lanes against one triangle after the other.
template <bool any, class T, class REAL>
INLINE unsigned test_triangles(const BvhJob& job, const TriangleBlock<T>* blocks, std::uint32_t count, State<REAL>& s) {
  unsigned hit = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const TriangleBlock<T>& block = blocks[i / TriangleBlock<T>::width];
    const std::uint32_t place = i % TriangleBlock<T>::width, id = block.id[place];
    const Crossing<REAL> x = cross(s.rays.o, s.sheared, corner<REAL>(block, 0, place), corner<REAL>(block, 1, place),
                                   corner<REAL>(block, 2, place), s.rays.tmin, s.rays.active);
    if (!lanes_of(x.hit)) continue;
    const REAL object = splat<REAL>(job.geometry->triangle_object.data()[id]), index = splat<REAL>(id);
    const auto nearer = comes_first(s, x, object, index);
    hit |= lanes_of(nearer);
    if (!any) take(s, x, nearer, object, index);
  }
  return hit;
}

template <bool any, class REAL>
INLINE unsigned test_leaf(const BvhJob& job, const BvhLeaf& leaf, State<REAL>& s) {
  unsigned hit = 0;
  if (leaf.quadric_count) hit = test_quadrics<any>(job, leaf, s);
  if (!leaf.triangle_count) return hit;
  if (job.float_blocks)
    return hit | test_triangles<any>(job, job.float_blocks + leaf.first_block, leaf.triangle_count, s);
  return hit | test_triangles<any>(job, job.double_blocks + leaf.first_block, leaf.triangle_count, s);
}

}  // namespace
}  // namespace rayengine::ISA
