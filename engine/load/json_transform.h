#pragma once

#include "accel/transform.h"
#include "engine/load/json_view.h"

namespace rayengine {

/// Reads a list of steps, applied first to last, each one of {"scale": s or [x,y,z]}, {"rotate": {"axis", "degrees"}}
/// and
/// {"translate": [x,y,z]}; or 16 numbers, the rows of an affine matrix. Throws Error with the line.
Affine read_transform(const JsonView& value);

}  // namespace rayengine
