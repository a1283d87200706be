#pragma once

#include "engine/scene/scene.h"

namespace rayengine {

/// Puts in what a scene lacks, each with a line in its notes: a camera that frames it, unless `has_camera`, and a
/// headlight when there is no light. The framing keeps the field of view, picture size and `up` that are there.
void complete(Scene& scene, bool has_camera);

/// The bounds of all that has an end: a floor without one should not hide how large the rest is.
Box finite_bounds(const Geometry& geometry);

/// Throws Error when a camera cannot make a picture: nothing to look along, `up` along the view, an angle outside
/// (0, 180) degrees, a side of 0 or of more than 65536 pixels.
void check(const Camera& camera);

}  // namespace rayengine
