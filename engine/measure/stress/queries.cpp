// Other queries than for the nearest hit, and the same scene asked in every way: rows 27 and 28.

#include "engine/measure/rays.h"
#include "engine/measure/stress/aim.h"
#include "engine/measure/stress/families.h"
#include "engine/measure/stress/shapes.h"

namespace rayengine::stability {

Cases parity_cases(std::size_t rays, std::uint64_t seed) {
  Cases cases;
  const auto add = [&](const std::string& name, std::shared_ptr<const Geometry> geometry) {
    cases.push_back({.variant = name, .geometry = std::move(geometry), .query = Query::all});
    cases.back().rays = random_rays(cases.back().geometry->bounds, rays, seed);
  };
  for (const Body& body : bodies())
    if (body.shape.capped || body.shape.type == QuadricType::sphere) add(body.name, alone(body.shape, turned(1)));
  add("mesh", alone(uv_sphere(24, 48), turned(1)));
  add("mixture", mixture());
  return cases;
}

Cases agreement_cases(std::size_t rays, std::uint64_t seed) {
  const auto scene = mixture();
  const std::vector<Ray> chords = random_rays(scene->bounds, rays, seed);
  Cases cases;
  const auto add = [&](const char* name, Query query, RayClass ray_class) {
    cases.push_back({.variant = name, .geometry = scene, .rays = chords, .query = query, .ray_class = ray_class});
  };
  add("closest, primary", Query::closest, RayClass::primary);
  add("closest, bounce", Query::closest, RayClass::bounce);
  add("any, shadow", Query::any, RayClass::shadow);
  add("any, bounce", Query::any, RayClass::bounce);
  add("all", Query::all, RayClass::bounce);
  return cases;
}

}  // namespace rayengine::stability
