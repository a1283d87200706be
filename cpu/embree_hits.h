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

  /// Whether all hits have ids that are known without a look at the scene: those of quadrics, and of one mesh.
  bool ids_are_known() const {
    const EmbreeScene::Level& top = scene_.level(RTC_INVALID_GEOMETRY_ID);
    return scene_.instances().empty() && (top.only_mesh != no_id || top.geometry->triangles.empty());
  }
  bool is_triangle(const EmbreeIds& ids) const { return ids.geom == scene_.level(ids.inst).triangles_id; }

  // These write to their last argument in place: copies of a hit cost as much as making it.
  /// `hit` holds t, the barycentrics and the unit normal, within the group if it is one.
  void finish_triangle(const EmbreeIds& ids, Hit& hit) const;
  /// `hit` holds t, the unit normal, and for barycentrics what the callbacks record: the part, and the object's bits.
  void finish_quadric(const EmbreeIds& ids, Hit& hit) const;
  /// `part` is what the callbacks answer: side or cap.
  void quadric(const Ray& ray, const EmbreeIds& ids, float part, double t, Hit& hit) const;

 private:
  void turn_normal(unsigned inst, Hit& hit) const;
  /// Ids within `level` to those that the caller knows.
  void set_ids(Hit& hit, unsigned inst, const EmbreeScene::Level& level, std::uint32_t object,
               std::uint32_t primitive) const;

  const EmbreeScene& scene_;
};

}  // namespace rayengine
