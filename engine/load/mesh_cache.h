#pragma once

#include <optional>

#include "engine/load/simplify.h"

namespace rayengine {

/// What simplify() gave for the same mesh, bit for bit, and the same numbers before. Files that are truncated, damaged
/// or of another version are as good as none.
std::optional<CoarserMesh> find_simplified(const Mesh& mesh, double tolerance,
                                           std::size_t most_decimated = default_most_decimated);

/// simplify(), from the cache folder (see mesh_files.h) where it has it, else kept there for the next time. A cache
/// that cannot be read or written is no error.
CoarserMesh simplify_cached(const Mesh& mesh, double tolerance, std::size_t most_decimated = default_most_decimated);

}  // namespace rayengine
