#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "accel/random.h"
#include "accel/ray_cone.h"

// Tiles of rays of every kind that a cone may have to hold, and whether it does, with 113 bits.
namespace rayengine::test {

using Wide = __float128;

struct WidePoint {
  Wide x, y, z;
  WidePoint(Wide x, Wide y, Wide z) : x(x), y(y), z(z) {}
  explicit WidePoint(const glm::vec3& v) : x(v.x), y(v.y), z(v.z) {}
  WidePoint operator+(const WidePoint& b) const { return {x + b.x, y + b.y, z + b.z}; }
  WidePoint operator-(const WidePoint& b) const { return {x - b.x, y - b.y, z - b.z}; }
};
inline Wide dot(const WidePoint& a, const WidePoint& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/// Whether the cone holds a point: |across| cos <= along sin, both sides squared.
inline bool holds(const RayCone& cone, const WidePoint& p) {
  if (cone.cosine < 0) return true;
  const WidePoint axis(cone.axis), w = p - WidePoint(cone.apex);
  const Wide along = dot(w, axis), axis_square = dot(axis, axis);
  const Wide across = dot(w, w) * axis_square - along * along;
  return along >= 0 && across * cone.cosine * cone.cosine <= along * along * cone.sine * cone.sine;
}

/// Whether the cone holds the ray from its origin on: two points tell, the cone being convex, one of them at infinity.
inline bool holds(const RayCone& cone, const ConeRay& ray) {
  return holds(cone, WidePoint(ray.origin)) && holds(cone, WidePoint(cone.apex) + WidePoint(ray.direction));
}

using Tile = std::vector<ConeRay>;

inline glm::vec3 somewhere(Random& random, double size) {
  return glm::vec3(size * random.between(-1, 1), size * random.between(-1, 1), size * random.between(-1, 1));
}

/// Directions within `spread` of one, origins within `size` of one.
inline Tile bundle(Random& random, std::size_t count, double spread, double size) {
  const glm::vec3 axis(random.direction()), center = somewhere(random, 1);
  Tile tile;
  for (std::size_t i = 0; i < count; ++i)
    tile.push_back({center + somewhere(random, size), axis + glm::vec3(spread * random.unit() * random.direction())});
  return tile;
}

inline Tile changed(Tile tile, const std::function<void(ConeRay&, std::size_t)>& change) {
  for (std::size_t i = 0; i < tile.size(); ++i) change(tile[i], i);
  return tile;
}

struct TileKind {
  const char* name;
  std::function<Tile(Random&)> make;
};

inline const std::array tile_kinds{
    TileKind{"coherent", [](Random& r) { return bundle(r, 256, .05, .01); }},
    TileKind{"pinhole", [](Random& r) { return bundle(r, 256, .3, 0); }},
    TileKind{"one_ray", [](Random& r) { return bundle(r, 1, 0, 0); }},
    TileKind{"two_rays", [](Random& r) { return bundle(r, 2, 1, 1); }},
    TileKind{"identical", [](Random& r) { return Tile(256, bundle(r, 1, 0, 0).front()); }},
    TileKind{"parallel", [](Random& r) { return bundle(r, 256, 0, std::pow(10, r.between(-6, 2))); }},
    TileKind{"nearly_parallel", [](Random& r) { return bundle(r, 256, std::pow(10, r.between(-8, -2)), .1); }},
    TileKind{"wide", [](Random& r) { return bundle(r, 64, r.between(.8, 1.3), .1); }},
    TileKind{"all_directions", [](Random& r) { return bundle(r, 256, 100, .1); }},
    TileKind{"opposite",
             [](Random& r) {
               return changed(bundle(r, 256, 0, .1), [](ConeRay& ray, std::size_t i) {
                 if (i % 2) ray.direction = -ray.direction;
               });
             }},
    TileKind{"tiny", [](Random& r) { return bundle(r, 256, .1, std::pow(10, r.between(-30, -10))); }},
    TileKind{"huge", [](Random& r) { return bundle(r, 256, .1, std::pow(10, r.between(3, 12))); }},
    TileKind{"too_far", [](Random& r) { return bundle(r, 256, .1, std::pow(10, r.between(14, 37))); }},
    TileKind{"set_out_behind_each_other",
             [](Random& r) {
               return changed(bundle(r, 256, .1, 0), [&](ConeRay& ray, std::size_t) {
                 ray.origin -= static_cast<float>(r.between(-4, 4)) * ray.direction;
               });
             }},
    TileKind{"any_length_of_direction",
             [](Random& r) {
               return changed(bundle(r, 256, .1, .1), [&](ConeRay& ray, std::size_t) {
                 ray.direction *= static_cast<float>(std::pow(10, r.between(-15, 15)));
               });
             }},
};

}  // namespace rayengine::test
