#pragma once

#include "engine/plan/recognise/candidate.h"

namespace rayengine::surfaces {

/// The shape that stands for a candidate, in the same object space. One that faces inward is a general quadric with its
/// matrix negated, whose outside is the other side.
QuadricShape shape_of(const Candidate& candidate);

}  // namespace rayengine::surfaces
