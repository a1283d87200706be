#include "cpu/reference/walk.h"

#include <algorithm>
#include <cmath>

namespace rayengine::reference {
namespace {

/// Bounds, generously, how far rounding moves the exact line when its ray is taken as doubles, as far as `bounds`
/// reaches.
double slack(const LocalRay& ray, const Box& bounds) {
  const auto largest = [](long double x, long double y, long double z) { return std::max({x, y, z}); };
  const auto& [o, d] = ray.size;
  const long double origin = largest(o.x.value, o.y.value, o.z.value);
  const long double direction = largest(d.x.value, d.y.value, d.z.value);
  const auto& v = ray.value.direction;
  const long double stretch = direction / largest(size_of(v.x), size_of(v.y), size_of(v.z));
  return static_cast<double>(0x1p-46L * (origin + (origin + bounds.extent()) * stretch));
}

glm::dvec3 rounded(const Vector<quad>& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}

/// A little further along the ray than t.
double beyond(double t) { return std::isinf(t) ? t : t + 0x1p-40 * std::abs(t); }

}  // namespace

Walk::Walk(const Geometry& geometry) : geometry_(geometry) {
  for (const auto& group : geometry.groups) groups_.push_back(std::make_unique<Walk>(*group));
  std::vector<Box> boxes(geometry.triangles.size() + geometry.quadrics.size() + geometry.instances.size());
  for (std::uint32_t item = 0; item < boxes.size(); ++item) {
    const Box box = box_of(item);
    if (box.empty()) continue;
    if (box.finite())
      boxes[item] = box;
    else
      unbounded_.push_back(item);
  }
  bvh_ = std::make_unique<Bvh>(boxes);
}

Box Walk::box_of(std::uint32_t item) const {
  const auto triangles = static_cast<std::uint32_t>(geometry_.triangles.size());
  const auto quadrics = static_cast<std::uint32_t>(geometry_.quadrics.size());
  if (item >= triangles + quadrics) return bounds(geometry_, geometry_.instances[item - triangles - quadrics]);
  if (item >= triangles) return bounds(geometry_, geometry_.quadrics[item - triangles]);
  Box box;
  for (int k = 0; k < 3; ++k) box.add(geometry_.vertex(geometry_.triangles[item][k]));
  return box;
}

std::size_t Walk::bytes() const {
  std::size_t total = bvh_->bytes() + unbounded_.capacity() * sizeof(std::uint32_t);
  for (const auto& group : groups_) total += group->bytes();
  return total;
}

void Walk::trace(const Ray& ray, Sink& sink) const { trace({ray, LocalRay(ray), nullptr}, sink); }

void Walk::trace(const Placed& placed, Sink& sink) const {
  for (const std::uint32_t item : unbounded_) trace_item(placed, item, sink);
  const Bvh::Segment segment{rounded(placed.local.value.origin), rounded(placed.local.value.direction),
                             -beyond(-placed.ray.tmin), slack(placed.local, bvh_->bounds())};
  bvh_->traverse(
      segment, [&] { return beyond(sink.reach()); }, [&](std::uint32_t item) { trace_item(placed, item, sink); });
}

void Walk::trace_item(const Placed& placed, std::uint32_t item, Sink& sink) const {
  const auto triangles = static_cast<std::uint32_t>(geometry_.triangles.size());
  const auto quadrics = static_cast<std::uint32_t>(geometry_.quadrics.size());
  if (item < triangles)
    try_triangle(placed, geometry_, item, sink);
  else if (item < triangles + quadrics)
    try_quadric(placed, geometry_, item - triangles, sink);
  else if (!placed.instance)
    trace_instance(placed, geometry_.instances[item - triangles - quadrics], sink);
}

void Walk::trace_instance(const Placed& placed, const Instance& instance, Sink& sink) const {
  groups_[instance.group]->trace({placed.ray, LocalRay(placed.local, instance.to_group), &instance}, sink);
}

}  // namespace rayengine::reference
