#pragma once

#include "accel/ray.h"
#include "cpu/embree_scene.h"

namespace rayengine {

/// Where Embree found a hit.
struct EmbreeIds {
  unsigned geom, prim, inst;
};

/// Turns what Embree answers into hits with the caller's ids and unit normals.
class EmbreeHits {
 public:
  explicit EmbreeHits(const EmbreeScene& scene) : scene_(scene) {}

  /// Whether every hit is one of the triangles of `only_mesh`, which are then all that there are.
  bool only_one_mesh() const {
    return scene_.level(RTC_INVALID_GEOMETRY_ID).only_mesh != no_id && scene_.instances().empty() &&
           scene_.geometry().quadrics.empty();
  }
  bool is_triangle(const EmbreeIds& ids) const { return ids.geom == scene_.level(ids.inst).triangles_id; }

  // These write to their last argument in place: copies of a hit cost as much as making it.
  /// `hit` holds t, the barycentrics and the unit normal, within the group if it is one.
  void finish_triangle(const EmbreeIds& ids, Hit& hit) const;
  /// `part` is what the callbacks answer: side or cap.
  void quadric(const Ray& ray, const EmbreeIds& ids, float part, double t, Hit& hit) const;

 private:
  /// Ids within `level` to those that the caller knows.
  void set_ids(Hit& hit, unsigned inst, const EmbreeScene::Level& level, std::uint32_t object,
               std::uint32_t primitive) const;

  const EmbreeScene& scene_;
};

}  // namespace rayengine
