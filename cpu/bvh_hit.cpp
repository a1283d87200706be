#include "cpu/bvh_hit.h"

#include <glm/geometric.hpp>
#include <vector>

#include "accel/surface.h"

namespace rayengine {
namespace {

void set_triangle(const BvhFound& found, Hit& hit) {
  const Geometry& g = *found.geometry;
  hit.object = g.triangle_object[found.answer.index];
  hit.primitive = found.answer.index - g.objects[hit.object].first;
  const glm::dvec3 normal = glm::normalize(triangle_normal(g, found.answer.index));
  hit.normal = glm::vec3(found.instance ? glm::normalize(found.instance->to_group.normal_to_world(normal)) : normal);
}

void set_quadric(const Ray& ray, const BvhFound& found, Hit& hit) {
  const BvhAnswer& a = found.answer;
  const Quadric& quadric = found.geometry->quadrics[a.index];
  hit.object = quadric.object, hit.primitive = a.part;
  hit.normal = glm::vec3(quadric_normal(*found.geometry, quadric, found.instance, a.part, ray.at(a.t)));
}

void set_hit(const Ray& ray, const BvhFound& found, Hit& hit) {
  const BvhAnswer& a = found.answer;
  hit.t = a.t, hit.error = a.error, hit.u = a.u, hit.v = a.v, hit.status = status_hit;
  if (a.part == BvhAnswer::triangle)
    set_triangle(found, hit);
  else
    set_quadric(ray, found, hit);
}

}  // namespace

void append(void* answers, const BvhAnswer& answer) {
  static_cast<std::vector<BvhAnswer>*>(answers)->push_back(answer);
}

Hit hit_of(const Ray& ray, const BvhFound& found) {
  Hit hit;
  set_hit(ray, found, hit);
  if (!found.instance) return hit;
  hit.primitive += found.instance->first_primitive + found.geometry->objects[hit.object].first_primitive;
  hit.object = found.instance->object;
  return hit;
}

void store_hits(const Geometry& geometry, const Ray* rays, std::span<const BvhAnswer> answers, Hit* hits) {
  for (std::size_t i = 0; i < answers.size(); ++i) {
    if (answers[i].part == BvhAnswer::miss)
      hits[i] = Hit{};
    else
      set_hit(rays[i], {&geometry, nullptr, answers[i]}, hits[i]);
  }
}

}  // namespace rayengine
