#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <limits>
#include <span>
#include <vector>

namespace rayengine {

inline constexpr std::uint32_t no_id = 0xFFFFFFFFu;
inline constexpr double infinity = std::numeric_limits<double>::infinity();

/// A ray: origin + t * direction for tmin < t <= tmax. The direction need not have unit length; t counts in its
/// lengths. The memory layout is that of a row of an (N, 8) float64 array: ox oy oz tmin dx dy dz tmax.
struct Ray {
  glm::dvec3 origin{0};
  double tmin = 0;
  glm::dvec3 direction{0, 0, 1};
  double tmax = infinity;

  glm::dvec3 at(double t) const { return origin + t * direction; }
};
static_assert(sizeof(Ray) == 64);

/// Bits of Hit::status and of the answers to any-hit queries.
enum Status : std::uint32_t {
  status_miss = 0,
  status_hit = 1,       ///< something was hit
  status_invalid = 2,   ///< the ray was NaN, infinite, without direction, or had tmin > tmax: answered as a miss
  status_tie = 4,       ///< another primitive is hit at exactly the same t; this one has the lowest ids
  status_resolved = 8,  ///< decided in more than single precision after single precision was unsure
};

/// The answer to a ray query. On a miss t is infinite and both ids are no_id.
struct Hit {
  double t = infinity;              ///< in units of the ray's direction
  double error = 0;                 ///< bound on |t - exact t|; 0 where the precision proves none
  std::uint32_t object = no_id;     ///< numbered from 0 in file order
  std::uint32_t primitive = no_id;  ///< triangle of a mesh; 0 side, 1 lower cap, 2 upper cap of a quadric
  float u = 0, v = 0;               ///< barycentrics of the triangle's second and third vertex; 0 on quadrics
  glm::vec3 normal{0};              ///< unit geometric normal: outward on quadrics, counter-clockwise on triangles
  std::uint32_t status = status_miss;

  bool hit() const { return status & status_hit; }
};
static_assert(sizeof(Hit) == 48);

/// The hits of many rays in one array: those of ray i are hits[offsets[i]] up to hits[offsets[i + 1]], sorted by t.
struct HitLists {
  std::vector<std::uint64_t> offsets;
  std::vector<Hit> hits;
};

/// What a batch of rays has in common: how coherent they are, and so how they are best traced.
enum class RayClass { primary, shadow, bounce };

/// False for what no tracer may be asked: NaN or infinite origin or direction, no direction, NaN bounds, tmin > tmax.
bool is_valid(const Ray& ray);

}  // namespace rayengine
