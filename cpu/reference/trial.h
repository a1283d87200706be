#pragma once

#include "cpu/reference/candidates.h"

namespace rayengine::reference {

/// A ray as the geometry sees it that is to be tried: the one that rays are traced in, or a group placed in it.
struct Placed {
  const Ray& ray;
  const LocalRay& local;
  const Instance* instance;  ///< null when it is not placed
};

/// Gives the ray's hits of one triangle, or quadric, that lie in its interval to `sink`.
void try_triangle(const Placed& placed, const Geometry& geometry, std::uint32_t triangle, Sink& sink);
void try_quadric(const Placed& placed, const Geometry& geometry, std::uint32_t index, Sink& sink);

}  // namespace rayengine::reference
