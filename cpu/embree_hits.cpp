#include "cpu/embree_hits.h"

#include <bit>
#include <glm/geometric.hpp>

#include "accel/surface.h"

namespace rayengine {

void EmbreeHits::set_ids(Hit& hit, unsigned inst, const EmbreeScene::Level& level, std::uint32_t object,
                         std::uint32_t primitive) const {
  hit.object = object, hit.primitive = primitive;
  if (inst == RTC_INVALID_GEOMETRY_ID) return;
  const Instance& instance = scene_.instances()[inst];
  hit.object = instance.object;
  hit.primitive += instance.first_primitive + level.geometry->objects[object].first_primitive;
}

void EmbreeHits::turn_normal(unsigned inst, Hit& hit) const {
  if (inst == RTC_INVALID_GEOMETRY_ID || hit.normal == glm::vec3(0)) return;
  const glm::dvec3 turned = scene_.instances()[inst].to_group.normal_to_world(glm::dvec3(hit.normal));
  hit.normal = glm::vec3(glm::normalize(turned));
}

void EmbreeHits::finish_triangle(const EmbreeIds& ids, Hit& hit) const {
  const EmbreeScene::Level& level = scene_.level(ids.inst);
  const std::uint32_t object = EmbreeScene::object_of(level, ids.prim);
  hit.status = status_hit;
  set_ids(hit, ids.inst, level, object, ids.prim - level.geometry->objects[object].first);
  turn_normal(ids.inst, hit);
}

void EmbreeHits::finish_quadric(const EmbreeIds& ids, Hit& hit) const {
  const auto part = static_cast<std::uint32_t>(hit.u), object = std::bit_cast<std::uint32_t>(hit.v);
  hit.u = hit.v = 0;
  set_ids(hit, ids.inst, scene_.level(ids.inst), object, part);
  turn_normal(ids.inst, hit);
}

void EmbreeHits::quadric(const Ray& ray, const EmbreeIds& ids, float part, double t, Hit& hit) const {
  const EmbreeScene::Level& level = scene_.level(ids.inst);
  const Geometry& g = *level.geometry;
  const QuadricBucket& bucket = *level.buckets[ids.geom - level.first_bucket];
  const Quadric& quadric = g.quadrics[bucket.quadrics[ids.prim]];
  const auto primitive = static_cast<std::uint32_t>(part);
  const Instance* instance = ids.inst == RTC_INVALID_GEOMETRY_ID ? nullptr : &scene_.instances()[ids.inst];
  hit.t = t;
  hit.error = 0;
  hit.u = hit.v = 0;
  hit.normal = glm::vec3(quadric_normal(g, quadric, instance, primitive, ray.at(t)));
  hit.status = status_hit;
  set_ids(hit, ids.inst, level, quadric.object, primitive);
}

}  // namespace rayengine
