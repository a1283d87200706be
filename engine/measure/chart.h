#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/measure/compare.h"
#include "engine/scene/scene.h"

// Speed against accuracy: what is gained by being less exact, and what being exact costs.
namespace rayengine {

struct ChartOptions {
  int threads = 0;  ///< 0: as many as the machine has
  int gpu = -1;     ///< an EGL device by its number; the best when negative
  std::function<void(double share)> progress;
};

/// One method on the rays of a scene's camera.
struct ChartRow {
  std::string method;  ///< a tracer, or embree-tess1 to 5: the quadrics as triangles, ever finer
  Precision precision = Precision::robust;
  int level = 0;  ///< of the tessellation; 0: the quadrics themselves
  std::uint64_t rays = 0;
  double mrays_per_s = 0;  ///< median
  Comparison errors;       ///< against `reference`, on all rays
  double rmse =
      0;  ///< root mean square difference of the picture by a light in the eye, |normal . direction|, from 0 to 1
  double build_seconds = 0;
  std::size_t bytes = 0;
  bool fastest_so_accurate = false;  ///< no method is faster and has a smaller median error: on the Pareto front

  double wrong_share() const;
};

/// All tracers and precisions, and tessellations at five levels at `fast` and `robust`, in turns. What cannot be made,
/// or takes longer than a second for 512 rays, is left out and named.
std::vector<ChartRow> chart(const Scene& scene, const ChartOptions& options, std::vector<std::string>& left_out);

/// One method on a unit sphere at random from far away.
struct DistanceRow {
  std::string method;
  std::optional<Precision> precision;  ///< none for a bare quadratic
  double distance = 0;
  double wrong_share = 0;       ///< of rays aimed at a disc of radius 1.2
  double max_t_error = 0;       ///< in radii
  double quadric_roundoff = 0;  ///< that the tracer states
};

/// All tracers and precisions, and bare quadratics beside them, at distances of 10 to 1e9 radii.
std::vector<DistanceRow> distance_sweep(const ChartOptions& options, std::vector<std::string>& left_out);

}  // namespace rayengine
