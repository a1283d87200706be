#pragma once

#include <optional>

#include "accel/geometry.h"
#include "cpu/reference/formulas.h"
#include "cpu/reference/root.h"

namespace rayengine::reference {

/// The textbook test by signed volumes. The ray passes a closed triangle abc when the tetrahedra that its direction
/// spans with the three edges, seen from the origin, have no two volumes of opposite sign and not all are zero, which
/// they are for a triangle without area or one that is seen edge on. Signs are exact.
std::optional<Crossing> cross_triangle(const LocalRay& ray, const Geometry& geometry, std::uint32_t triangle);

/// Of the triangles that a ray passes at an edge or a vertex, whether it is this one that counts: the one that would be
/// passed inside if the ray were moved by (e, e^2, e^3) for an e of next to nothing. A volume changes by
/// (e, e^2, e^3) . (direction x edge) then, so that neighbours agree. So a line through a closed mesh passes an even
/// number of triangles. Source of the idea: Edelsbrunner, Muecke, "Simulation of Simplicity" (ACM Transactions on
/// Graphics 9, 1990).
bool owns_crossing(const LocalRay& ray, const Geometry& geometry, std::uint32_t triangle);

/// t of the triangle's plane without rounding.
Root exact_t(const Line<Exact>& ray, const Geometry& geometry, std::uint32_t triangle);

/// Barycentrics of the second and third vertex where the ray passes the triangle.
std::array<double, 2> barycentrics(const LocalRay& ray, const Geometry& geometry, std::uint32_t triangle);

/// (b - a) x (c - a)
Vector<quad> normal(const Geometry& geometry, std::uint32_t triangle);

}  // namespace rayengine::reference
