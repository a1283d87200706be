#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "accel/geometry.h"
#include "engine/scene/scene.h"

// Rays to measure and to test with. All are deterministic: the same arguments give the same rays on any machine.
namespace rayengine {

/// One ray through the middle of every pixel, row by row from the upper left corner; directions have unit length.
std::vector<Ray> primary_rays(const Camera& camera);

/// From what every ray hit to every light of the scene, lights running fastest. tmax is at a point light, and infinite
/// for a directional one. Origins stand off the surface by what single precision needs, on the side that the ray came
/// from; lights behind the surface are left out.
std::vector<Ray> shadow_rays(const Scene& scene, std::span<const Ray> rays, std::span<const Hit> hits);

/// From what every ray hit in one direction chosen at random, with a diffuse surface's density, on the side that the
/// ray came from.
std::vector<Ray> bounce_rays(const Geometry& geometry, std::span<const Ray> rays, std::span<const Hit> hits,
                             std::uint64_t seed = 1);

/// Chords: each from one random point to another on the sphere about `bounds`; unbounded sides count as the unit box.
std::vector<Ray> random_rays(const Box& bounds, std::size_t count, std::uint64_t seed = 1);

/// Rays that are hard to decide: from random points outside to vertices and points of edges of triangles, and to
/// silhouettes, rims and clip planes of quadrics, as near as double precision comes to them. None for an empty
/// geometry.
std::vector<Ray> aimed_rays(const Geometry& geometry, std::size_t count, std::uint64_t seed = 1);

}  // namespace rayengine
