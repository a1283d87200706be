#pragma once

#include <functional>
#include <span>
#include <vector>

#include "engine/render/render.h"

namespace rayengine {

/// The cameras of `frames` pictures at equal steps around the point that a camera looks at, about its up vector, from
/// where it stands counter-clockwise seen from above.
std::vector<Camera> turntable(const Camera& camera, int frames);

/// Called with each frame when it is done, in order, from threads that come and go; the next frame goes on meanwhile.
using FrameDone = std::function<void(int frame, RenderResult& result)>;

/// Renders what each of the cameras sees. The end of a frame, where threads would run out of work, and what is done
/// with it overlap with the next. `options.progress` gets the share of all frames. Returns the sums over all frames,
/// with the wall clock of the whole. Throws Error before any work when one of the cameras sees nothing.
RenderStats render_frames(const Scene& scene, std::span<const Camera> cameras, Tracer& tracer,
                          const RenderOptions& options, const FrameDone& done);

}  // namespace rayengine
