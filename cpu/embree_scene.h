#pragma once

#include <embree3/rtcore.h>

#include <memory>
#include <vector>

#include "cpu/quadric_bucket.h"

namespace rayengine {

/// An Embree scene of one Geometry, the scenes of its groups, and the tables that lead from Embree's ids back to ours.
class EmbreeScene {
 public:
  /// Embree takes coordinates up to this; beyond, its own checks refuse them.
  static constexpr double range = 1.8e18;
  /// Origins further out than so many times the scene's extent are moved before they are rounded to float.
  static constexpr double near_extents = 8;

  /// Throws Error when Embree fails, or when the geometry's finite parts lie beyond the range of its single precision.
  /// All-hits queries need a scene that calls filters; other queries would pay for that at every hit.
  EmbreeScene(std::shared_ptr<const Geometry> geometry, Precision precision, Build how, bool calls_filters = false);
  ~EmbreeScene();
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  RTCScene scene() const { return top_.scene; }
  const Geometry& geometry() const { return *geometry_; }
  /// By Embree's instID.
  const std::vector<Instance>& instances() const { return geometry_->instances; }
  /// The box of everything that is finite.
  const Box& finite_bounds() const { return finite_bounds_; }
  double build_seconds() const { return build_seconds_; }
  std::size_t bytes() const;
  int native_packet() const { return native_packet_; }

  /// The part of a scene that one Embree scene holds. geomIDs: instances first (top level only), then triangles,
  /// buckets.
  struct Level {
    RTCScene scene = nullptr;
    const Geometry* geometry = nullptr;
    unsigned triangles_id = RTC_INVALID_GEOMETRY_ID;
    unsigned first_bucket = 0;
    std::uint32_t only_mesh = no_id;  ///< the object of all triangles, if it is one: spares a look-up, often uncached
    std::vector<std::unique_ptr<QuadricBucket>> buckets;
  };

  /// The object that a triangle of a level is part of.
  static std::uint32_t object_of(const Level& level, std::uint32_t triangle) {
    return level.only_mesh != no_id ? level.only_mesh : level.geometry->triangle_object[triangle];
  }

  /// The level that a hit with this instID lies in.
  const Level& level(unsigned inst) const {
    return inst == RTC_INVALID_GEOMETRY_ID ? top_ : groups_[geometry_->instances[inst].group];
  }

 private:
  /// How the boxes of a level's quadrics differ from the quadrics' own.
  struct Margins {
    double padding;        ///< added to all sides, for what is rounded
    double reach = range;  ///< where the sides of unbounded quadrics are
  };
  std::vector<Margins> group_margins(double padding) const;
  void build(Level& level, const Geometry& geometry, const Margins& margins);
  unsigned attach(const Level& level, RTCGeometry geometry) const;
  void attach_instances();
  void attach_triangles(Level& level);
  void attach_quadrics(Level& level, const Margins& margins);

  std::shared_ptr<const Geometry> geometry_;
  Precision precision_;
  Build build_;
  bool calls_filters_;
  RTCDevice device_ = nullptr;
  Level top_;
  std::vector<Level> groups_;
  Box finite_bounds_;
  double build_seconds_ = 0;
  std::ptrdiff_t embree_bytes_ = 0;
  int native_packet_ = 8;
};

}  // namespace rayengine
