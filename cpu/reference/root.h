#pragma once

#include "cpu/reference/exact.h"

namespace rayengine::reference {

/// A root of a t^2 + 2 b t + c, which has two or is linear: t = (-b + r) / a, or (-b - r) / a, where r is the root of
/// b^2 - a c.
struct Root {
  Exact a, b, c;
  bool plus = false;  ///< the one where the form rises with t; does not matter when it is linear
};

/// n / d, with d not 0, as the root of a linear form.
Root fraction(const Exact& n, const Exact& d);

/// The sign of the root less n / d, without rounding; d is not 0.
int compare(const Root& root, const Exact& n, const Exact& d);

/// The sign of s - t, without rounding. Where either is a root of more than a linear form, both must be moderate.
int compare(const Root& s, const Root& t);

/// Whether comparing it with another cannot leave the exponents of quads.
bool is_moderate(const Root& root);

}  // namespace rayengine::reference
