#pragma once

#include <cstdint>
#include <vector>

#include "engine/scene/scene.h"

namespace rayengine {

/// How far an answer may lie from the exact one.
struct Tolerance {
  enum class Unit { pixels, scene };
  double value = 0;  ///< 0: not at all
  Unit unit = Unit::pixels;
};

/// Throws Error unless it is a number and not negative.
void check(const Tolerance& tolerance);

/// Triangles of a mesh below which there is nothing to gain by another representation, and its patches are not looked
/// at.
inline constexpr std::uint32_t smallest_mesh = 256;

/// What a plan must know of one object. Lengths in units of the scene.
struct ObjectStatistics {
  Object::Kind kind = Object::Kind::mesh;
  QuadricType type = QuadricType::sphere;  ///< of quadrics
  std::uint32_t triangles = 0;             ///< of meshes
  double radius = 0;                       ///< half the diagonal of its bounds; infinite where it has none
  double thickness = 0;                    ///< the least semi-axis of a quadric
  double distance = 0;                     ///< from the eye to its bounds; 0 within them
  // Of meshes that are not too small:
  double spacing = 0;                        ///< side of a square as large as a triangle and its neighbour
  double quadric_share = 0, ball_share = 0;  ///< of the patches: as in Patches
};

/// What a plan must know of a scene.
struct SceneStatistics {
  std::vector<ObjectStatistics> objects;
  std::uint64_t triangles = 0, quadrics = 0, instances = 0;  ///< what instances place is counted once
  TraitsByType traits{};                                     ///< of the quadrics
  double extent = 0;                                         ///< the largest finite coordinate, the eye's included
  double pixel = 0;  ///< what a pixel subtends at the middle of the picture, in radians
  double rays = 0;   ///< that will be asked for
  bool coherent = true;

  std::uint64_t primitives() const { return triangles + quadrics + instances; }
};

/// Looks at bounds and at a sample of each mesh, so that the time it takes grows with the number of objects, not with
/// their size.
SceneStatistics gather_statistics(const Scene& scene, double rays, bool coherent);

/// Rays that a picture will ask for, about: the eye's, one to each light, and bounces where something shines.
double expected_rays(const Scene& scene, int spp);

/// What a pixel subtends at the middle of the picture, in radians, for small ones.
double pixel_angle(const Camera& camera);

/// How far an object may be moved for a tolerance, in units of the scene.
double allowance(const Tolerance& tolerance, const ObjectStatistics& object, double pixel);

}  // namespace rayengine
