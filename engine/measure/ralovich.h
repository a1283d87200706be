#pragma once

#include <array>
#include <functional>
#include <string>
#include <vector>

#include "engine/measure/ralovich_scenes.h"
#include "gpu/points/points_caster.h"

namespace rayengine {

/// What is cast: rays of the camera, those and to the light, and one reflection with its shadows beside.
enum class CastMode { RC, SC, RT };
inline constexpr std::array cast_modes{CastMode::RC, CastMode::SC, CastMode::RT};
std::string_view to_string(CastMode mode);

struct RalovichOptions {
  int gpu = -1;  ///< an EGL device by its number; the best when negative
  int runs = 5;  ///< medians of so many, after one that warms up; what is compared takes turns
  glm::ivec2 size{512, 512};
  std::function<void(double share)> progress;
};

/// What a picture took by one method.
struct CastTime {
  std::string scene;
  std::size_t triangles = 0;
  CastMode mode{};
  std::string method;     ///< points, points_without_gs or fragment
  int vertex_bytes = 0;   ///< of a ray in the vertex buffers; 0 where there are none
  CastSeconds seconds{};  ///< medians
};

/// Each mode by every method, with the paper's vertices and with smaller ones, through the scene's grid. Throws Error
/// without a GPU, and as PointsCaster.
std::vector<CastTime> time_casts(const NamedScene& scene, const RalovichOptions& options);

/// How the work of `points` is shared by its stages, when every ray is tested against every triangle.
struct StageShares {
  std::string scene;
  std::size_t triangles = 0;
  CastMode mode{};
  double vertex = 0, geometry = 0, fragment = 0;  ///< percent; the last with rasterizing and blending
};
std::vector<StageShares> share_of_stages(const NamedScene& scene, const RalovichOptions& options);

}  // namespace rayengine
