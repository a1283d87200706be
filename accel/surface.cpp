#include "accel/surface.h"

#include "accel/solve.h"

namespace rayengine {
namespace {

GroupRay world_ray(const Ray& ray) { return {kernel_vec(ray.origin), kernel_vec(ray.direction)}; }

GroupRay group_ray(const PrimitiveRef& ref, const Ray& ray) {
  const GroupRay world = world_ray(ray);
  return ref.instance ? formulas::transformed(world, map_of(ref.instance->to_group)) : world;
}

Solution solve(const PrimitiveRef& ref, const Ray& ray, double t_guess) {
  const GroupRay local = group_ray(ref, ray);
  return ref.is_triangle() ? solve_triangle(ref, local, t_guess) : solve_quadric(ref, local, t_guess);
}

/// Needs a mesh with normals; zero where they cancel.
glm::dvec3 interpolated_normal(const PrimitiveRef& ref, const glm::dvec2& barycentrics) {
  const Geometry& g = *ref.geometry;
  const glm::uvec3 t = g.triangles[ref.triangle()];
  const glm::dvec3 a(g.normals[t.x]), b(g.normals[t.y]), c(g.normals[t.z]);
  return unit(
      to_world(ref.instance, (1 - barycentrics.x - barycentrics.y) * a + barycentrics.x * b + barycentrics.y * c));
}

}  // namespace

Surface surface_at(const Geometry& geometry, const Ray& ray, const Hit& hit) {
  const PrimitiveRef ref = resolve(geometry, hit.object, hit.primitive);
  const Solution s = solve(ref, ray, hit.t);
  Surface result;
  const auto place = formulas::place_at(world_ray(ray), s.t, s.distance, s.error);
  result.position = glm_vec(place.position);
  result.error = place.error;
  result.normal = result.shading_normal = s.normal;
  result.is_triangle = ref.is_triangle();
  if (result.is_triangle && !ref.geometry->normals.empty())
    if (const glm::dvec3 n = interpolated_normal(ref, s.barycentrics); n != glm::dvec3(0)) result.shading_normal = n;
  result.magnitude = std::max(s.magnitude, largest_component(result.position));
  result.spread = s.spread;
  result.material = ref.geometry->objects[ref.object].material;
  return result;
}

Hit refine(const Geometry& geometry, const Ray& ray, const Hit& hit) {
  const PrimitiveRef ref = resolve(geometry, hit.object, hit.primitive);
  Solution s = solve(ref, ray, hit.t);
  if (!ref.is_triangle()) s = with_traced_t(ref, group_ray(ref, ray), s);
  Hit result = hit;
  result.t = s.t;
  result.error = s.error;
  if (ref.is_triangle())
    result.u = static_cast<float>(s.barycentrics.x), result.v = static_cast<float>(s.barycentrics.y);
  result.normal = glm::vec3(s.normal);
  return result;
}

}  // namespace rayengine
