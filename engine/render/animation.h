#pragma once

#include <functional>

#include "engine/render/render.h"

namespace rayengine {

/// The camera after `frame` of `frames` equal steps around the point that it looks at, about its up vector, from where
/// it stands counter-clockwise seen from above.
Camera turntable(const Camera& camera, int frame, int frames);

/// Called with each frame when it is done, in order, from threads that come and go; the next frame goes on meanwhile.
using FrameDone = std::function<void(int frame, RenderResult& result)>;

/// Renders a turn of the camera. The end of a frame, where threads would run out of work, and what is done with it
/// overlap with the next. `options.progress` gets the share of all frames. Returns the sums over all frames, with the
/// wall clock of the whole.
RenderStats render_turn(const Scene& scene, Tracer& tracer, const RenderOptions& options, int frames,
                        const FrameDone& done);

}  // namespace rayengine
