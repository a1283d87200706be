#pragma once

#include "engine/load/json_view.h"
#include "engine/scene/scene.h"

namespace rayengine {

/// Reads where a camera stands and looks, and how wide: `from`, `at`, `up`, `fov`; what is not there stays. True when
/// it says where it stands or looks.
bool read_pose(JsonFields& fields, Camera& camera);

}  // namespace rayengine
