#include "engine/plan/statistics.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "accel/tracer.h"
#include "engine/plan/patches.h"

namespace rayengine {
namespace {

// Patches that are looked at: of a mesh, and of all of them together while each has a few.
constexpr std::size_t enough_patches = 24, fewest_patches = 4, most_patches = 1024;

/// What is 1 in object space is at least so much in the world; a general form's size is known by its bounds alone.
double thickness(const Quadric& q, double radius) {
  const glm::dmat3& m = q.to_object.linear;
  const double unit = 1 / std::sqrt(glm::dot(m[0], m[0]) + glm::dot(m[1], m[1]) + glm::dot(m[2], m[2]));
  return q.type == QuadricType::general ? std::min(unit, radius) : unit;
}

ObjectStatistics at(const Box& box, const glm::dvec3& eye, Object::Kind kind) {
  ObjectStatistics result{.kind = kind};
  result.radius = box.finite() ? glm::length(box.size()) / 2 : box.empty() ? 0 : infinity;
  result.distance = box.empty() ? infinity : std::sqrt(box.squared_distance(eye));
  return result;
}

ObjectStatistics look_at(const Geometry& g, const Quadric& q, const glm::dvec3& eye) {
  ObjectStatistics result = at(bounds(g, q), eye, Object::Kind::quadric);
  result.type = q.type;
  result.thickness = thickness(q, result.radius);
  return result;
}

ObjectStatistics look_at(const Geometry& g, std::uint32_t mesh, const Box& box, const glm::dvec3& eye,
                         std::uint32_t patches) {
  ObjectStatistics result = at(box, eye, Object::Kind::mesh);
  result.triangles = primitive_count(g, mesh);
  if (result.triangles < smallest_mesh) return result;
  const Patches seen = look_at_patches(g, mesh, patches);
  result.spacing = std::sqrt(2 * seen.area);
  result.quadric_share = seen.quadric_share;
  result.ball_share = seen.ball_share;
  return result;
}

void look_at_meshes(const Geometry& g, const glm::dvec3& eye, std::span<ObjectStatistics> objects) {
  std::vector<std::uint32_t> meshes;
  meshes.reserve(g.mesh_bounds.size());
  for (std::uint32_t i = 0; meshes.size() < g.mesh_bounds.size(); ++i)
    if (g.objects[i].kind == Object::Kind::mesh) meshes.push_back(i);
  const auto patches = static_cast<std::uint32_t>(
      std::clamp(most_patches / std::max<std::size_t>(meshes.size(), 1), fewest_patches, enough_patches));
  tbb::parallel_for(std::size_t{0}, meshes.size(),
                    [&](std::size_t i) { objects[meshes[i]] = look_at(g, meshes[i], g.mesh_bounds[i], eye, patches); });
}

/// Several instances may be parts of one object.
void look_at_instances(const Geometry& g, const glm::dvec3& eye, std::span<ObjectStatistics> objects) {
  if (g.instances.empty()) return;
  std::vector<Box> boxes(objects.size());
  for (const Instance& i : g.instances) boxes[i.object].add(bounds(g, i));
  for (std::size_t i = 0; i < objects.size(); ++i)
    if (g.objects[i].kind == Object::Kind::instance) objects[i] = at(boxes[i], eye, Object::Kind::instance);
}

void look_at_quadrics(const Geometry& g, const glm::dvec3& eye, std::span<ObjectStatistics> objects) {
  tbb::parallel_for(std::size_t{0}, g.quadrics.size(),
                    [&](std::size_t i) { objects[g.quadrics[i].object] = look_at(g, g.quadrics[i], eye); });
}

void count(const Geometry& g, SceneStatistics& result) {
  result.triangles += g.triangles.size();
  result.quadrics += g.quadrics.size();
  add_traits(result.traits, g.quadrics);
}

}  // namespace

void check(const Tolerance& tolerance) {
  if (!(tolerance.value >= 0 && tolerance.value < infinity))
    throw Error("a tolerance of " + std::to_string(tolerance.value) + " says nothing: give 0, which is exact, or more");
}

SceneStatistics gather_statistics(const Scene& scene, double rays, bool coherent) {
  const Geometry& g = *scene.geometry;
  const Camera& camera = scene.camera;
  SceneStatistics result;
  result.objects.resize(g.objects.size());
  look_at_meshes(g, camera.from, result.objects);
  look_at_instances(g, camera.from, result.objects);
  look_at_quadrics(g, camera.from, result.objects);
  count(g, result);
  for (const auto& group : g.groups) count(*group, result);
  result.instances = g.instances.size();
  const glm::dvec3 eye = glm::abs(camera.from);
  result.extent = std::max({g.bounds.finite() ? g.bounds.extent() : 0, eye.x, eye.y, eye.z});
  result.pixel = pixel_angle(camera);
  result.rays = rays;
  result.coherent = coherent;
  return result;
}

double pixel_angle(const Camera& camera) { return 2 * std::tan(glm::radians(camera.fov) / 2) / camera.size.y; }

double expected_rays(const Scene& scene, int spp) {
  const bool shines =
      std::ranges::any_of(scene.materials, [](const Material& m) { return m.reflect + m.transmit > 0; });
  const double pixels = static_cast<double>(scene.camera.size.x) * scene.camera.size.y * spp;
  return pixels * (1 + static_cast<double>(scene.lights.size())) * (shines ? 2 : 1);
}

double allowance(const Tolerance& tolerance, const ObjectStatistics& object, double pixel) {
  return tolerance.value * (tolerance.unit == Tolerance::Unit::pixels ? pixel * object.distance : 1);
}

}  // namespace rayengine
