#pragma once

#include <span>
#include <string>
#include <vector>

#include "accel/surface.h"
#include "engine/render/render.h"

namespace rayengine {

/// EXR channel names: Z; N.X N.Y N.Z; object; primitive; P.X P.Y P.Z; error; status.
std::vector<std::string> channel_names(std::span<const Aov> aovs);

/// Writes the values of one pixel, in the order of channel_names. Z is the distance from the eye along the ray,
/// infinite on a miss; N the unit shading normal and P the position in world space, zero on a miss; ids are exact up to
/// 2^24, and -1 on a miss; error is the tracer's bound on the distance, status
/// the bits of Status. `ray` must have a direction of unit length; `object` is what the caller knows the hit's object
/// as.
void write_aovs(std::span<const Aov> aovs, const Geometry& geometry, const Ray& ray, const Hit& hit,
                std::uint32_t object, float* out);

}  // namespace rayengine
