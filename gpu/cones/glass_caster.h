#pragma once

#include <glm/vec3.hpp>
#include <memory>
#include <span>
#include <vector>

#include "accel/geometry.h"
#include "gpu/device/context.h"
#include "gpu/points/points_caster.h"

namespace rayengine {

/// A latitude-longitude image, rows from the top: its middle column lies in +x, its top row in +z.
struct CastEnvironment {
  int width = 0, height = 0;
  std::vector<glm::vec3> colors;
};

struct GlassOptions {
  enum class Method {
    hierarchical,  ///< cones around tiles of rays
    ray_engine,    ///< the baseline, after Carr et al. (2002): a full-screen pass for every primitive
  };
  Method method = Method::hierarchical;
  int tile = 16;        ///< rays along a side of a tile
  int path_length = 5;  ///< rays of a path that are traced
  /// Of the ray engine's passes, only every `stride`-th is made and timed, and counts `stride` times; what they miss is
  /// found hierarchically, and not counted.
  int stride = 1;
  int device = -1;  ///< an EGL device by its number; the best when negative
};

/// Pictures of ideal glass and mirrors before an environment. Source: Szecsi, "The Hierarchical Ray Engine" (WSCG
/// 2006): each generation of rays is traced as make_cones_tracer does, then refracted or reflected on the device; a bit
/// of the stencil for each generation masks the paths that have ended, beyond eight none; rays that hit nothing, and
/// the last of a path, look up the environment. Triangles alone; no light is lost on the way.
class GlassCaster {
 public:
  /// Object::material indexes `indices`, of refraction; 0 for a mirror. Throws Error without a GPU, when a material is
  /// missing, and when the scene holds quadrics or more than the device's textures do.
  GlassCaster(std::shared_ptr<const Geometry> geometry, std::span<const float> indices,
              const CastEnvironment& environment, const GlassOptions& options = {});
  ~GlassCaster();

  /// Linear colours, row by row from the upper left corner. From any thread, one at a time. Throws Error when the
  /// device fails, or the picture is larger than its textures.
  std::vector<glm::vec3> cast(const CastView& view);

  /// Draws `view` and waits until it is done, without reading it back.
  CastSeconds time(const CastView& view);

  const GpuInfo& gpu() const;

  /// Half the opening angles, in radians, of the cones around the rays of the given generation, 1 for the camera's: one
  /// a tile, row by row. Pi for a cone that holds everything, negative where all paths have ended.
  std::vector<float> openings(const CastView& view, int generation);

 private:
  class Device;
  std::unique_ptr<GlThread> thread_;
  std::unique_ptr<Device> device_;
};

}  // namespace rayengine
