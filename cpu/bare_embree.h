#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "accel/geometry.h"
#include "accel/ray.h"

namespace rayengine {

/// What stands in Embree's scene for our geometry.
enum class BareShape {
  triangles,  ///< triangles as they are; no quadrics
  spheres,    ///< spheres as Embree's own sphere points; triangles as they are
};

/// What Embree itself answers: t, barycentrics and its own ids, or RTC_INVALID_GEOMETRY_ID on a miss.
struct BareHit {
  float t, u, v;
  std::uint32_t geometry, primitive;
};

/// Embree called directly with nothing between: the yardstick that our tracers are measured against, and not one of
/// them. Rays must be valid (see is_valid), since Embree's build may abort on others.
class BareEmbree {
 public:
  /// Whether the geometry can be told to Embree in this shape: no instances, and no quadrics but whole round
  /// spheres.
  static bool holds(const Geometry& geometry, BareShape shape);

  /// Needs holds(). Default scene flags, or Embree's robust mode.
  BareEmbree(std::shared_ptr<const Geometry> geometry, BareShape shape, bool robust);
  ~BareEmbree();

  double build_seconds() const;  ///< of Embree's commit alone
  std::size_t bytes() const;     ///< by Embree's memory monitor

  /// Packets of the width that the processor has for primary and shadow rays, single rays for others; spans of equal
  /// length. May be called from several threads at once.
  void closest(std::span<const Ray> rays, std::span<BareHit> hits, RayClass ray_class) const;
  void any(std::span<const Ray> rays, std::span<std::uint32_t> status, RayClass ray_class) const;

  /// The same with our ids.
  Hit hit(const BareHit& bare) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace rayengine
