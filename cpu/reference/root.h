#pragma once

#include "cpu/reference/exact.h"

namespace rayengine::reference {

/// A root of a t^2 + 2 b t + c, which has two or is linear: t = (-b + r) / a, or (-b - r) / a, where r is the root of
/// b^2 - a c.
struct Root {
  Exact a, b, c;
  bool plus = false;
};

/// The sign of the root less n / d, without rounding; d is not 0.
int compare(const Root& root, const Exact& n, const Exact& d);

}  // namespace rayengine::reference
