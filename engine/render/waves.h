#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "engine/render/departure.h"
#include "engine/render/environment.h"
#include "engine/render/photon_map.h"
#include "engine/render/tracer_gate.h"
#include "engine/scene/scene.h"

namespace rayengine {

/// What all threads that render one picture share; nothing in it changes.
struct Picture {
  const Geometry& geometry;
  std::span<const Light> lights;
  std::span<const Material> materials;
  const Environment& environment;
  Limits limits;
  int depth;  ///< bounces after the primary ray
  const PhotonMap* caustics = nullptr;
  std::span<const std::uint32_t> object_numbers = {};  ///< as in Scene
};

/// Traces the trees of rays that grow from primary rays, level by level in waves (Whitted, "An improved illumination
/// model for shaded display", 1980), and sums what each of them sees. Buffers are kept from call to call; one thread
/// uses one object.
///
/// The sum of a sample is formed in an order that depends on its own rays alone, never on how samples share waves.
class Waves {
 public:
  Waves(const Picture& picture, TracerGate& gate);

  /// Room for `count` rays to start from, for the caller to fill; directions must have unit length.
  std::span<Ray> primary(std::size_t count);
  /// The linear colour that each of them sees. Valid until the next call.
  std::span<const glm::vec3> radiance();

  /// Rays traced so far: primary, shadow, reflected, refracted; and how many of them the tracer called invalid.
  const std::array<std::uint64_t, 4>& rays() const { return rays_; }
  std::uint64_t invalid_rays() const { return invalid_; }

 private:
  /// What a ray brings to the picture: `weight` times what it sees, added to `sample`.
  struct Path {
    glm::vec3 weight;
    std::uint32_t sample : 31;
    std::uint32_t refracted : 1;
  };
  /// Rays that are traced together, and their paths.
  struct Wave {
    std::span<const Ray> rays;
    std::span<const Path> paths;
  };
  /// Rays that wait to be traced, in the order of their samples.
  struct Queue {
    std::vector<Ray> rays;
    std::vector<Path> paths;
    std::size_t size = 0;  ///< the arrays only grow: what they held before is overwritten in place

    void reserve(std::size_t more);
    void add(const Departure& from, const glm::dvec3& direction, double tmax, const glm::vec3& weight,
             std::uint32_t sample, bool refracted = false) {
      from.start(rays[size], direction, tmax);
      paths[size++] = {weight, sample, refracted};
    }
    /// The end of the wave that starts at `first`: whole samples, as many as fit `batch` rays, at least one.
    std::size_t wave_end(std::size_t first, std::size_t batch) const;
    Wave wave(std::size_t first, std::size_t last) const {
      return {{rays.data() + first, last - first}, {paths.data() + first, last - first}};
    }
  };
  /// A wave in the order in which it is traced, and where its rays went.
  struct Sorting {
    std::vector<Ray> rays;
    std::vector<Hit> hits;
    std::vector<std::uint32_t> places;
  };
  /// A hit that lights may reach, and change what is seen.
  struct LitPoint {
    Departure departure;
    glm::dvec3 normal;  ///< shading normal, facing the eye
    glm::vec3 view;     ///< unit, towards the eye
    std::uint32_t material;
    Path path;
  };

  void trace_sorted(const Wave& wave);
  void trace(std::size_t depth, const Wave& wave);
  void shade(const Wave& wave, Queue* next);
  void leave(const Ray& ray, const Hit& hit, const Path& path);
  void shade(const Ray& ray, const Surface& surface, const Path& path, LitPoint& point, Queue* next);
  void scatter(const Ray& ray, const Surface& surface, const LitPoint& point, Queue& next);
  void spawn(Queue& next, const LitPoint& from, const glm::dvec3& direction, const glm::vec3& weight, bool refracted);
  template <class Way>
  std::span<const std::uint32_t> turned_to(const Way& to_light);
  void shine(const Light& light, RayClass ray_class);
  void add_unshadowed(RayClass ray_class);

  const Picture& picture_;
  TracerGate& gate_;
  float brightest_light_ = 1;  ///< or as bright as white, if that is brighter
  std::vector<Queue> levels_;  ///< by depth; 0 holds the primary rays
  Queue shadow_;
  std::vector<Hit> hits_;
  Sorting sorting_;
  std::vector<Surface> surfaces_;
  std::vector<std::uint32_t> shadow_status_;
  std::vector<LitPoint> points_;  ///< the first lit_ of them count
  std::size_t lit_ = 0;
  std::vector<std::uint32_t> facing_;  ///< those of them that face a light
  std::vector<glm::vec3> radiance_;
  std::array<std::uint64_t, 4> rays_{};
  std::uint64_t invalid_ = 0;
};

}  // namespace rayengine
