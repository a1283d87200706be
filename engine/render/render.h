#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <vector>

#include "accel/tracer.h"
#include "engine/scene/image.h"
#include "engine/scene/scene.h"

namespace rayengine {

enum class Shading {
  full,    ///< Whitted: ambient, Blinn-Phong, hard shadows, reflection, refraction
  direct,  ///< Lambert and hard shadows only, two-sided, lights scaled as docs/rendering.md says
};

/// Arbitrary output variables beside the colour.
enum class Aov { depth, normal, object, primitive, position, error, status };

struct RenderOptions {
  int depth = 5;  ///< reflections and refractions that may follow each other
  int spp = 1;    ///< samples a pixel; 1 is its centre
  Shading shading = Shading::full;
  std::vector<Aov> aovs;
  int caustics = 0;  ///< photons sent from the lights to find what glass and mirrors focus: see docs/rendering.md
  int threads = 0;   ///< 0: as many as the machine has
  std::function<void(double share)> progress;  ///< called now and then, from any thread, with the share done
};

struct RenderStats {
  std::array<std::uint64_t, 4> rays{};  ///< primary, shadow, reflected, refracted
  double seconds = 0;                   ///< wall clock of render()
  double tracer_seconds = 0;            ///< spent in the tracer, summed over threads
  double shading_seconds = 0;           ///< spent outside it, summed over threads
  std::uint64_t invalid_rays = 0;
  std::uint64_t photon_rays = 0;  ///< traced on the way to caustics; not among `rays`
};

/// Channels R, G, B, A (linear), then those of the AOVs in the order asked for: Z; N.X N.Y N.Z; object; primitive; P.X
/// P.Y P.Z; error.
struct RenderResult {
  Image image;
  RenderStats stats;
};

/// Renders scene.camera.size pixels in waves of rays through `tracer`, which must trace scene.geometry. The picture
/// does not depend on the number of threads.
RenderResult render(const Scene& scene, Tracer& tracer, const RenderOptions& options = {});

/// The primary ray through pixel coordinates (x, y), in pixels from the upper left corner; its direction has unit
/// length.
Ray camera_ray(const Camera& camera, double x, double y);

}  // namespace rayengine
