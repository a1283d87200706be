#pragma once

// All that a host application needs: build a Geometry, make a Tracer for it by name, ask it; or render a Scene.
// Outside of this project it is included as <rayengine/rayengine.h>.
#include "accel/geometry.h"
#include "accel/ray.h"
#include "accel/surface.h"
#include "accel/tracer.h"
#include "engine/plan/planned.h"
#include "engine/plan/verify.h"
#include "engine/render/render.h"
#include "engine/scene/scene.h"
#include "engine/tracers.h"
