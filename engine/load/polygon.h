#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace rayengine {

/// The largest polygon that is not convex which `triangulate` takes: its time grows with the square of the size.
inline constexpr std::size_t largest_concave_polygon = 65536;

/// Cuts a planar polygon of n >= 3 vertices, convex or not, into n - 2 triangles of indices into it, which turn as it
/// does. Convex ones become a fan about vertex 0; others lose their ears one by one, after Meisters 1975, with the list
/// of ears kept as Eberly, "Triangulation by Ear Clipping" (2002), does. What has no proper answer (crossing itself, or
/// without area) still ends, with n - 2 triangles. Throws Error above largest_concave_polygon.
std::vector<glm::uvec3> triangulate(std::span<const glm::dvec3> polygon);

}  // namespace rayengine
