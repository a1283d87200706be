#pragma once

#include <algorithm>
#include <cmath>

#include "accel/norms.h"
#include "accel/quadric.h"
#include "accel/ray.h"

namespace rayengine {

/// Error bounds in double hold where no product over- or underflows. Up to here, and for what is not zero by nature
/// from the inverse on, none does; whatever is beyond is for exact arithmetic.
inline constexpr double moderate_limit = 0x1p100;

inline bool is_moderate(double size) { return size >= 1 / moderate_limit && size <= moderate_limit; }

inline bool is_moderate(const Ray& ray) {
  return largest_component(ray.origin) <= moderate_limit && is_moderate(largest_component(ray.direction));
}

/// All coefficients zero or moderate.
inline bool is_moderate(const GeneralForm& form) {
  return std::all_of(form.matrix.begin(), form.matrix.end(),
                     [](double a) { return a == 0 || is_moderate(std::abs(a)); });
}

}  // namespace rayengine
