#pragma once

#include "engine/plan/model.h"

namespace rayengine {

/// For plans: simplify(), which keeps what it makes in the cache folder, and looks there first.
Simplifier cached_simplifier();

}  // namespace rayengine
