#include "engine/plan/statistics.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <span>

#include "accel/tracer.h"
#include "engine/plan/patches.h"

namespace rayengine {
namespace {

// Patches that are looked at: of a mesh, one for so many of its triangles, and of all meshes while each has a few.
constexpr std::size_t enough_patches = 24, fewest_patches = 4, most_patches = 1024, triangles_a_patch = 1024;

/// What is 1 in object space is at least so much in the world; a general form's size is known by its bounds alone.
double thickness(const Quadric& q, double radius) {
  const glm::dmat3& m = q.to_object.linear;
  const double unit = 1 / std::sqrt(glm::dot(m[0], m[0]) + glm::dot(m[1], m[1]) + glm::dot(m[2], m[2]));
  return q.type == QuadricType::general ? std::min(unit, radius) : unit;
}

ObjectStatistics at(const Box& box, const glm::dvec3& eye) {
  ObjectStatistics result;
  result.radius = box.finite() ? glm::length(box.size()) / 2 : box.empty() ? 0 : infinity;
  result.distance = box.empty() ? infinity : std::sqrt(box.squared_distance(eye));
  return result;
}

void look_at_patches(const Geometry& g, std::uint32_t patches, ObjectStatistics& mesh) {
  const Patches seen = look_at_patches(g, mesh.object, patches);
  mesh.spacing = std::sqrt(2 * seen.area);
  mesh.quadric_share = seen.quadric_share;
  mesh.ball_share = seen.ball_share;
}

/// What is seen of many in one look at each.
struct Seen {
  Drift drift;
  TraitsByType traits{};
};

/// look(range, seen) adds what a part of so many shows.
template <class Look>
Seen see(std::size_t count, Look&& look) {
  constexpr std::size_t grain = 1024;
  const auto add = [&](const tbb::blocked_range<std::size_t>& range, Seen seen) {
    look(range, seen);
    return seen;
  };
  const auto both = [](Seen a, const Seen& b) {
    a.drift.add(b.drift);
    add_traits(a.traits, b.traits);
    return a;
  };
  return tbb::parallel_reduce(tbb::blocked_range<std::size_t>(0, count, grain), Seen{}, add, both);
}

Seen see_meshes(const Geometry& g, const glm::dvec3& eye, double extent) {
  return see(g.mesh_bounds.size(), [&](const auto& range, Seen& seen) {
    for (std::size_t i = range.begin(); i < range.end(); ++i) seen.drift.add(at(g.mesh_bounds[i], eye), extent);
  });
}

/// From outside, no quadric is nearer than the bounds of all, nor larger; those of each then need not be worked out.
Seen see_quadrics(const Geometry& g, const glm::dvec3& eye, double extent) {
  const ObjectStatistics all = at(g.quadric_bounds, eye);
  const auto look = [&](const Quadric& q) {
    ObjectStatistics result = all.distance > 0 && q.type != QuadricType::general ? all : at(bounds(g, q), eye);
    result.thickness = thickness(q, result.radius);
    return result;
  };
  return see(g.quadrics.size(), [&](const auto& range, Seen& seen) {
    for (const Quadric& q : std::span(g.quadrics).subspan(range.begin(), range.size())) {
      seen.drift.add(look(q), extent);
      add_traits(seen.traits, std::span(&q, 1));
    }
  });
}

/// Those that are not too small, in the order of objects.
std::vector<ObjectStatistics> large_meshes(const Geometry& g, const glm::dvec3& eye) {
  std::vector<ObjectStatistics> meshes;
  std::size_t place = 0;  // among meshes
  for (std::uint32_t i = 0; place < g.mesh_bounds.size(); ++i) {
    if (g.objects[i].kind != Object::Kind::mesh) continue;
    const Box& box = g.mesh_bounds[place++];
    const std::uint32_t triangles = primitive_count(g, i);
    if (triangles < smallest_mesh) continue;
    meshes.push_back(at(box, eye));
    meshes.back().object = i;
    meshes.back().triangles = triangles;
  }
  const std::size_t share = std::min(enough_patches, most_patches / std::max<std::size_t>(meshes.size(), 1));
  tbb::parallel_for(std::size_t{0}, meshes.size(), [&](std::size_t i) {
    const std::size_t patches =
        std::max(std::min<std::size_t>(share, meshes[i].triangles / triangles_a_patch), fewest_patches);
    look_at_patches(g, static_cast<std::uint32_t>(patches), meshes[i]);
  });
  return meshes;
}

/// Several instances may be parts of one object.
Drift of_instances(const Geometry& g, const glm::dvec3& eye, double extent) {
  Drift drift;
  for (std::size_t i = 0; i < g.instances.size();) {
    Box box;
    const std::uint32_t object = g.instances[i].object;
    for (; i < g.instances.size() && g.instances[i].object == object; ++i) box.add(bounds(g, g.instances[i]));
    drift.add(at(box, eye), extent);
  }
  return drift;
}

}  // namespace

void check(const Tolerance& tolerance) {
  if (!(tolerance.value >= 0 && tolerance.value < infinity))
    throw Error("a tolerance of " + std::to_string(tolerance.value) + " says nothing: give 0, which is exact, or more");
}

void Drift::add(const ObjectStatistics& o, double extent) {
  const double way = std::min(o.distance + 2 * o.radius, 4 * extent);
  // Within an object's bounds hits may be as near as a part of its size.
  const double nearest = o.distance > 0 ? o.distance : 0.05 * std::min(o.radius, extent);
  const double robust = extent + way, textbook = robust + (o.thickness > 0 ? way * way / o.thickness : 0);
  const double per_length = nearest > 0 ? 1 / nearest : 0;
  add(Drift{robust, robust * per_length, textbook, textbook * per_length});
}

void Drift::add(const Drift& other) {
  length = std::max(length, other.length);
  angle = std::max(angle, other.angle);
  textbook_length = std::max(textbook_length, other.textbook_length);
  textbook_angle = std::max(textbook_angle, other.textbook_angle);
}

SceneStatistics gather_statistics(const Scene& scene, double rays, bool coherent) {
  const Geometry& g = *scene.geometry;
  const glm::dvec3 from = scene.camera.from, eye = glm::abs(from);
  SceneStatistics result;
  result.extent = std::max({g.bounds.finite() ? g.bounds.extent() : 0, eye.x, eye.y, eye.z});
  const auto drift_of = [&](Object::Kind kind) -> Drift& { return result.drift[static_cast<std::size_t>(kind)]; };
  const Seen quadrics = see_quadrics(g, from, result.extent);
  drift_of(Object::Kind::mesh) = see_meshes(g, from, result.extent).drift;
  drift_of(Object::Kind::quadric) = quadrics.drift;
  drift_of(Object::Kind::instance) = of_instances(g, from, result.extent);
  result.traits = quadrics.traits;
  result.meshes = large_meshes(g, from);
  result.objects = g.objects.size();
  result.triangles = g.triangles.size();
  result.quadrics = g.quadrics.size();
  for (const auto& group : g.groups) {
    result.triangles += group->triangles.size();
    result.quadrics += group->quadrics.size();
    add_traits(result.traits, group->quadrics);
  }
  result.instances = g.instances.size();
  result.pixel = pixel_angle(scene.camera);
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
