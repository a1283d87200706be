#pragma once

#include <cstdint>
#include <optional>

#include "engine/load/simplify.h"

namespace rayengine {

/// Bytes that meshes may take in the cache folder (see accel/cache_folder.h); those unused for longest go first.
inline constexpr std::uintmax_t mesh_cache_limit = std::uintmax_t{512} << 20;

/// Whether anything is kept that was made of a mesh of so many triangles: quick, for there mostly is not.
bool may_have_simplified(std::size_t triangles);

/// What simplify() gave for the same mesh, bit for bit, and the same numbers before. Files that are truncated, damaged
/// or of another version are as good as none.
std::optional<CoarserMesh> find_simplified(const Mesh& mesh, double tolerance,
                                           std::size_t most_decimated = default_most_decimated);

/// simplify(), from the cache where it has it, else kept there for the next time. A cache that cannot be read or
/// written is no error.
CoarserMesh simplify_cached(const Mesh& mesh, double tolerance, std::size_t most_decimated = default_most_decimated);

}  // namespace rayengine
