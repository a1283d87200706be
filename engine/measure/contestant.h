#pragma once

#include <memory>
#include <span>
#include <string>

#include "accel/geometry.h"
#include "accel/tracer.h"

namespace rayengine {

/// Something that can be timed on rays, and whose last answers can be looked at afterwards.
class Contestant {
 public:
  virtual ~Contestant() = default;

  virtual std::string name() const = 0;
  virtual Precision precision() const = 0;
  virtual Limits limits() const = 0;
  virtual double build_seconds() const = 0;
  virtual std::size_t bytes() const = 0;

  /// Makes room for `rays` answers and fills it with what nobody answers.
  virtual void poison(std::size_t rays) = 0;
  virtual void closest(std::span<const Ray> rays, RayClass ray_class) = 0;
  virtual void any(std::span<const Ray> rays, RayClass ray_class) = 0;

  /// The answer to ray `i` of the last query of that kind. Throws Error when it was never written.
  virtual Hit hit(std::size_t i) const = 0;
  virtual std::uint32_t status(std::size_t i) const = 0;
};

/// Names of the yardsticks: plain Embree 3 on the triangles, on Embree's own spheres, and on tessellated quadrics.
std::span<const std::string_view> yardsticks();

std::unique_ptr<Contestant> make_contestant(std::unique_ptr<Tracer> tracer);

/// Plain Embree 3 on the quadrics as triangles (see tessellate()); its hits have the quadrics' ids, and the triangles'
/// normals. Null when there is no such tessellation, or the precision is another than fast or robust.
std::unique_ptr<Contestant> make_tessellated(std::string name, std::shared_ptr<const Geometry> geometry, int level,
                                             Precision precision);

/// Makes a tracer or a yardstick by name, at a precision. Null when a yardstick cannot hold this geometry or precision.
/// Throws Error like make_tracer().
std::unique_ptr<Contestant> make_contestant(const std::string& name, std::shared_ptr<const Geometry> geometry,
                                            Precision precision, int threads);

}  // namespace rayengine
