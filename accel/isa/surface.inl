// Surfaces at several hits at once, compiled once per instruction set (see lanes.inl).

#include "accel/isa/lanes.inl"
#include "accel/isa/surface_batch.h"
#include "accel/solve_formulas.h"

namespace rayengine::ISA {
namespace {

using Reals = Lanes<double>;
using Vec = formulas::Vec<Reals>;

INLINE Vec load(const SurfaceRow* rows, int at) {
  return {read<Reals>(rows[0] + at), read<Reals>(rows[1] + at), read<Reals>(rows[2] + at)};
}

INLINE void store(SurfaceRow* rows, int at, const Vec& v) {
  write(rows[0] + at, v.x);
  write(rows[1] + at, v.y);
  write(rows[2] + at, v.z);
}

INLINE formulas::LocalRay<Reals> load_ray(const SurfaceRows& rows, int at) {
  return {load(rows.origin, at), load(rows.direction, at)};
}

/// One over a vector's length, and whether that is so: see formulas::is_regular.
struct Length {
  Reals inverse;
  kernels::Mask<Reals> regular, zero;

  INLINE explicit Length(const Vec& v) {
    const Reals square = formulas::dot(v, v);
    inverse = 1 / kernels::root(square);
    regular = formulas::is_regular(square), zero = square == 0;
  }
};

INLINE void store_surface(SurfaceRows& rows, int at, const formulas::Place<Reals>& place, const Vec& normal,
                          Reals magnitude, Reals spread) {
  store(rows.position, at, place.position);
  store(rows.normal, at, normal);
  write(rows.error + at, place.error);
  write(rows.magnitude + at, kernels::larger(magnitude, formulas::largest_component(place.position)));
  write(rows.spread + at, spread);
}

INLINE void store_regular(SurfaceRows& rows, int at, const kernels::Mask<Reals>& regular) {
  write(rows.regular + at, kernels::pick(regular, splat<Reals>(1), Reals{}));
}

/// Stores the interpolated normal, or the flat one where it is zero; the lanes where that is all there is to it.
INLINE kernels::Mask<Reals> store_shading(TriangleBatch& batch, int at, const Vec& flat, Reals u, Reals v) {
  using formulas::plus, formulas::times;
  const auto normal = [&](int corner) { return load(batch.corner_normals[corner], at); };
  const Vec bent = plus(plus(times(1 - u - v, normal(0)), times(u, normal(1))), times(v, normal(2)));
  const Length length(bent);
  const Vec unit = times(length.inverse, bent);
  store(batch.shading_normal, at,
        {kernels::pick(length.zero, flat.x, unit.x), kernels::pick(length.zero, flat.y, unit.y),
         kernels::pick(length.zero, flat.z, unit.z)});
  return kernels::either(length.regular, length.zero);
}

INLINE void solve_triangles(TriangleBatch& batch, int at) {
  const auto ray = load_ray(batch, at);
  const auto corner = [&](int i) { return load(batch.corners[i], at); };
  const auto plane = formulas::plane_of(corner(0), corner(1), corner(2), ray);
  const Length length(plane.n);
  const Vec unit = formulas::times(length.inverse, plane.n);
  const auto x = formulas::cross_plane(plane, corner(0), ray, unit, length.inverse);
  const Reals under = kernels::magnitude(plane.under);
  store_surface(batch, at, formulas::place_at(ray, x.t, x.error * under * length.inverse, x.error), unit, plane.largest,
                length.inverse * plane.sides);
  auto regular = kernels::both(length.regular, under > plane.under_error);
  if (batch.smooth)
    regular = kernels::both(regular, store_shading(batch, at, unit, x.u, x.v));
  else
    store(batch.shading_normal, at, unit);
  store_regular(batch, at, regular);
}

INLINE void solve_quadrics(QuadricBatch& batch, int at) {
  const auto ray = load_ray(batch, at);
  const auto form = [&](int i) { return read<Reals>(batch.form[i] + at); };
  const formulas::Map<Reals> map{load(batch.linear[0], at), load(batch.linear[1], at), load(batch.linear[2], at),
                                 load(batch.map_origin, at)};
  const auto x = formulas::cross_side(formulas::Diagonal<Reals>{form(0), form(1), form(2), form(3), form(4)}, map, ray,
                                      read<Reals>(batch.t + at));
  const Length length(x.steepest);
  const Vec unit = formulas::times(length.inverse, x.steepest);
  store_surface(batch, at, formulas::place_at(ray, x.t, x.form_error * length.inverse, x.error), unit, Reals{},
                Reals{});
  store(batch.shading_normal, at, unit);
  store_regular(batch, at, length.regular);
}

void triangles(TriangleBatch& batch) {
  for (int at = 0; at < surface_batch; at += lane_count<Reals>) solve_triangles(batch, at);
}

void quadrics(QuadricBatch& batch) {
  for (int at = 0; at < surface_batch; at += lane_count<Reals>) solve_quadrics(batch, at);
}

}  // namespace

constinit const SurfaceSolvers surface_solvers{triangles, quadrics};

}  // namespace rayengine::ISA
