#pragma once

#include "engine/plan/model.h"

namespace rayengine {

/// For plans: simplify() and recognise(), which keep what they make in the cache folder, and look there first.
MeshTools cached_mesh_tools();

}  // namespace rayengine
