#pragma once

#include "accel/quadric.h"

namespace rayengine {

/// The matrices of the unit primitives, by type: here so that code built for one instruction set has them as constants.
inline constexpr std::array<QuadricMatrix, quadric_type_count> unit_matrices{{
    {1, 0, 0, 0, 1, 0, 0, 1, 0, -1},     // sphere
    {1, 0, 0, 0, 1, 0, 0, 0, 0, -1},     // cylinder
    {1, 0, 0, 0, 1, 0, 0, -1, 0, 0},     // cone
    {1, 0, 0, 0, 1, 0, 0, 0, -0.5, 0},   // paraboloid
    {1, 0, 0, 0, 1, 0, 0, -1, 0, -1},    // hyperboloid1
    {1, 0, 0, 0, 1, 0, 0, -1, 0, 1},     // hyperboloid2, signed so that the inside is negative
    {1, 0, 0, 0, -1, 0, 0, 0, -0.5, 0},  // saddle
    {0, 0, 0, 0, 0, 0, 0, 0, 0.5, 0},    // plane
    {0, 0, 0, 0, 0, 0, 0, 0, 0.5, 0},    // disk
    {},                                  // general
}};

}  // namespace rayengine
