#pragma once

#include <vector>

#include "engine/scene/scene.h"
#include "gpu/points/points_caster.h"

// What casters on the GPU can be told of a scene: they take flat normals, one background colour, and no glass.
namespace rayengine {

/// Throws Error when the camera sees nothing.
CastView cast_view(const Camera& camera);
std::vector<CastLight> cast_lights(const Scene& scene);
std::vector<CastMaterial> cast_materials(const Scene& scene);

}  // namespace rayengine
