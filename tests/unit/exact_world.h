#pragma once

#include <array>
#include <vector>

#include "accel/geometry.h"
#include "tests/unit/dyadic.h"

// Rays against one primitive in rational arithmetic, by the definitions and no method: what the oracle is held against.
namespace rayengine::test {

using Point = std::array<Dyadic, 3>;

struct ExactRay {
  Point origin, direction;
};
ExactRay exact_ray(const Ray& ray);
ExactRay exact_ray(const Ray& ray, const WorldToObject& map);

/// Where a ray meets something: a fraction, or a root of a t^2 + 2 b t + c with a > 0.
struct Place {
  bool is_hit = true;  ///< false where two roots are one: a miss by convention, even where it leads into a cone
  bool is_root = false;
  bool upper = false;   ///< of the two roots
  Dyadic p = 0, q = 1;  ///< the fraction p / q, q > 0
  Dyadic a = 0, b = 0, c = 0;
  std::uint32_t primitive = 0;

  /// The sign of this less n / d.
  int compare(const Dyadic& n, const Dyadic& d) const;
  /// The same with another place of the same quadric, or with any fraction.
  int compare(const Place& other) const;
};

/// All hits on a quadric by ascending t; those at equal t by primitive. Of a capped one, the first at each t between
/// whose two sides the line changes from inside to outside.
std::vector<Place> exact_hits(const Ray& ray, const Geometry& geometry, const Quadric& quadric);
/// The same on all triangles.
std::vector<Place> exact_hits(const Ray& ray, const Geometry& geometry);

/// Whether no double is nearer to the place than t.
bool is_nearest_double(double t, const Place& place);

}  // namespace rayengine::test
