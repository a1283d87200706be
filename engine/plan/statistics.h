#pragma once

#include <array>
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
  std::uint32_t object = 0;
  std::uint32_t triangles = 0;  ///< of meshes
  double radius = 0;            ///< half the diagonal of its bounds; infinite where it has none
  double thickness = 0;         ///< the least semi-axis of a quadric
  double distance = 0;          ///< from the eye to its bounds; 0 within them
  // Of meshes that are not too small:
  double spacing = 0;                        ///< side of a square as large as a triangle and its neighbour
  double quadric_share = 0, ball_share = 0;  ///< of the patches: as in Patches
};

/// How far round-off moves the hits of some objects at most, for a unit of round-off: in units of the scene, and as
/// seen from the eye, in radians. First-order: of coordinates as large as the scene's, and of the way to the object and
/// through it. The textbook quadric loses the square of that way against the radius: it is as if the radius were off.
struct Drift {
  double length = 0, angle = 0;
  double textbook_length = 0, textbook_angle = 0;

  void add(const ObjectStatistics& object, double extent);
  void add(const Drift& other);
};

/// What a plan must know of a scene.
struct SceneStatistics {
  std::vector<ObjectStatistics> meshes;                      ///< that are not too small, by ascending number
  std::uint64_t objects = 0;                                 ///< of all kinds
  std::uint64_t triangles = 0, quadrics = 0, instances = 0;  ///< what instances place is counted once
  std::array<Drift, 3> drift{};                              ///< by kind of objects
  TraitsByType traits{};                                     ///< of the quadrics
  double extent = 0;                                         ///< the largest finite coordinate, the eye's included
  double pixel = 0;  ///< what a pixel subtends at the middle of the picture, in radians
  double rays = 0;   ///< that will be asked for
  bool coherent = true;

  std::uint64_t primitives() const { return triangles + quadrics + instances; }
};

/// Looks at bounds and at a sample of each mesh, so that the time it takes grows with the number of objects, not with
/// their size. Of many objects nothing but extremes is kept: to write more down took longer than to look.
SceneStatistics gather_statistics(const Scene& scene, double rays, bool coherent);

/// Rays that a picture will ask for, about: the eye's, one to each light, and bounces where something shines.
double expected_rays(const Scene& scene, int spp);

/// What a pixel subtends at the middle of the picture, in radians, for small ones.
double pixel_angle(const Camera& camera);

/// How far an object may be moved for a tolerance, in units of the scene.
double allowance(const Tolerance& tolerance, const ObjectStatistics& object, double pixel);

}  // namespace rayengine
