#pragma once

#include <functional>
#include <vector>

#include "accel/geometry.h"
#include "accel/random.h"

// Rays for the suite: each from numbers of its own, so that more rays begin with the fewer.
namespace rayengine::stability {

using MakeRay = std::function<Ray(Random& random, std::size_t i)>;

std::vector<Ray> make_rays(std::size_t count, std::uint64_t seed, const MakeRay& make);

/// From `from` through `to`, by a direction of unit length.
Ray through(const glm::dvec3& from, const glm::dvec3& to);

/// From `distance` away in any direction, to points of a disc of `radius` about `center` that faces it.
std::vector<Ray> at_disc(const glm::dvec3& center, double radius, double distance, std::size_t count,
                         std::uint64_t seed);

/// To the points from `distance` away, in any direction; points take turns.
std::vector<Ray> at_points(const std::vector<glm::dvec3>& points, double distance, std::size_t count,
                           std::uint64_t seed);

/// In turns a point of an edge, a vertex, and a point of the face, of triangles at random.
glm::dvec3 on_triangle(const Geometry& geometry, Random& random, std::size_t turn);

/// A place on the surface, as the oracle has it.
struct Spot {
  glm::dvec3 point, normal;
};
/// Where random chords first meet the geometry: `count` at most.
std::vector<Spot> spots(const std::shared_ptr<const Geometry>& geometry, std::size_t count, std::uint64_t seed);

/// A unit vector across `direction`, at random.
glm::dvec3 across(const glm::dvec3& direction, Random& random);

}  // namespace rayengine::stability
