#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "accel/ray.h"

namespace rayengine {

/// Reads rays from an (N, 8) float32 or float64 array in C order: ox oy oz tmin dx dy dz tmax. Throws Error on any
/// other.
std::vector<Ray> read_rays(const std::filesystem::path& file);
void write_rays(const std::filesystem::path& file, std::span<const Ray> rays);

/// Writes the structured array of the design: t f8, object u4, primitive u4, u f4, v f4, nx ny nz f4, error f8, status
/// u4.
void write_hits(const std::filesystem::path& file, std::span<const Hit> hits);
void write_offsets(const std::filesystem::path& file, std::span<const std::uint64_t> offsets);

}  // namespace rayengine
