#pragma once

#include "accel/quadric.h"

namespace rayengine {

/// What code is made for: every type, and apart from them whole spheres under one scale for all axes.
inline constexpr int ball_kind = static_cast<int>(quadric_type_count);
inline constexpr int quadric_kind_count = ball_kind + 1;
constexpr QuadricType type_of(int kind) {
  return kind == ball_kind ? QuadricType::sphere : static_cast<QuadricType>(kind);
}
int kind_of(const Quadric& quadric);

}  // namespace rayengine
