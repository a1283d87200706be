#pragma once

#include <optional>

#include "engine/plan/recognise/recognise.h"

namespace rayengine {

/// What recognise() gave for the same mesh, bit for bit, and the same numbers before, without the triangles that each
/// quadric replaces. Files that are truncated, damaged or of another version are as good as none.
std::optional<Recognition> find_recognised(const Mesh& mesh, double tolerance, Pieces pieces);

/// recognise(), from the cache folder (see mesh_files.h) where it has it, then without the triangles that each quadric
/// replaces; else kept there for the next time. A cache that cannot be read or written is no error.
Recognition recognise_cached(const Mesh& mesh, double tolerance, Pieces pieces);

}  // namespace rayengine
