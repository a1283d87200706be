#include "cpu/reference/trial.h"

#include "cpu/reference/quadric.h"
#include "cpu/reference/triangle.h"

namespace rayengine::reference {
namespace {

void report(const Placed& placed, Candidate candidate, Sink& sink) {
  if (const Instance* instance = placed.instance) {
    candidate.primitive += candidate.geometry->objects[candidate.object].first_primitive + instance->first_primitive;
    candidate.object = instance->object;
  }
  if (in_interval(placed.ray, candidate)) sink.add(candidate);
}

}  // namespace

void try_triangle(const Placed& placed, const Geometry& geometry, std::uint32_t triangle, Sink& sink) {
  const auto crossing = cross_triangle(placed.local, geometry, triangle);
  if (!crossing) return;
  const std::uint32_t object = geometry.triangle_object[triangle];
  report(placed,
         {*crossing, object, triangle - geometry.objects[object].first, &geometry, placed.instance, triangle, true},
         sink);
}

void try_quadric(const Placed& placed, const Geometry& geometry, std::uint32_t index, Sink& sink) {
  const Quadric& quadric = geometry.quadrics[index];
  for (const Crossing& crossing : cross_quadric(LocalRay(placed.local, quadric.to_object), geometry, quadric))
    report(placed, {crossing, quadric.object, crossing.primitive, &geometry, placed.instance, index, false}, sink);
}

}  // namespace rayengine::reference
