#include "engine/plan/recognise/shape.h"

#include "engine/plan/recognise/profile.h"

namespace rayengine::surfaces {
namespace {

/// Sides of boxes that are not to clip anything, in units of what they are beside.
constexpr double beside = 1.001;

/// A box whose ends in z clip, and whose sides lie beside the surface of revolution.
Box box_around(const Candidate& c) {
  double reach = 1;
  if (c.type != QuadricType::cylinder && c.type != QuadricType::sphere)
    for (const double z : c.clip) reach = std::max(reach, std::sqrt(std::abs(z)) + std::abs(z) + 1);
  reach *= beside;
  return {{-reach, -reach, c.clip[0]}, {reach, reach, c.clip[1]}};
}

Box box_over_rectangle(const Candidate& c) {
  const double deep = c.type == QuadricType::saddle ? c.half.y * c.half.y : 1;
  const double high = c.type == QuadricType::saddle ? c.half.x * c.half.x : 1;
  return {{-c.half.x, -c.half.y, -deep * beside}, {c.half.x, c.half.y, high * beside}};
}

QuadricMatrix negated(QuadricMatrix m) {
  for (double& a : m) a = -a;
  return m;
}

}  // namespace

QuadricShape shape_of(const Candidate& candidate) {
  QuadricShape shape;
  shape.type = candidate.type;
  const bool rectangle = candidate.type == QuadricType::plane || candidate.type == QuadricType::saddle;
  if (rectangle)
    shape.box = box_over_rectangle(candidate);
  else if (candidate.type != QuadricType::sphere && candidate.type != QuadricType::disk)
    shape.clip = candidate.clip;
  if (!candidate.inward) return shape;
  if (!rectangle) shape.box = box_around(candidate);
  shape.matrix = negated(unit_matrix(candidate.type));
  shape.type = QuadricType::general;
  shape.clip = {};
  return shape;
}

}  // namespace rayengine::surfaces
