#pragma once

#include <optional>
#include <vector>

#include "engine/plan/plan.h"
#include "engine/scene/scene.h"

namespace rayengine {

/// A quadric of another type than `general`, and how far its surface may lie from the one that it is taken for.
struct CanonicalQuadric {
  Quadric quadric;
  double distance = 0;  ///< bound, in units of the scene; 0: the same real surface, point by point
};

/// The unit primitive, under a scale along its axes, whose surface a general form is: where the ten numbers are a
/// positive multiple of those of x^2 A + y^2 E + z^2 H + 2 z I + J with a type's signs, and the box leaves all of that
/// type or cuts it as its own clip does. Where roots have to be taken, the scale is rounded by up to 4 units each: with
/// E the error of the map L to object space, the point n of the unit primitive moves by |L^-1 E L^-1 n|. Nothing where
/// it is none of them, or where no bound is known.
std::optional<CanonicalQuadric> canonical(const Quadric& general, const GeneralForm& form);

/// A scene whose general quadrics are those of another type where they can be.
struct CanonicalScene {
  Scene scene;                  ///< shares the other's geometry where nothing changed
  std::vector<Choice> choices;  ///< one for each type that was found
};

/// Replaces those of the top level that so move by no more than their share of the tolerance; at 0, by nothing.
CanonicalScene in_canonical_forms(const Scene& scene, const Tolerance& tolerance);

}  // namespace rayengine
