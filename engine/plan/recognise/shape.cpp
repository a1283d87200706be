#include "engine/plan/recognise/shape.h"

#include "engine/plan/recognise/profile.h"

namespace rayengine::surfaces {
namespace {

/// Sides of boxes that are not to clip anything, in units of what they are beside.
constexpr double beside = 1.001;

/// A box whose ends in z clip, and whose sides lie beside the surface of revolution.
Box box_around(const Candidate& c) {
  const double reach = beside * std::max(section_radius(c.type, c.clip[0]), section_radius(c.type, c.clip[1]));
  if (is_whole_turn(c)) return {{-reach, -reach, c.clip[0]}, {reach, reach, c.clip[1]}};
  const double side = beside * std::sin(std::min(c.half_angle, 0.5 * std::numbers::pi));
  return {{std::cos(c.half_angle), -side, c.clip[0]}, {reach, side, c.clip[1]}};
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
  shape.capped = candidate.capped;
  const bool rectangle = candidate.type == QuadricType::plane || candidate.type == QuadricType::saddle;
  const bool unit_saddle = candidate.type == QuadricType::saddle && candidate.half == glm::dvec2(1);
  if (rectangle && !unit_saddle)
    shape.box = box_over_rectangle(candidate);
  else if (!rectangle && !is_whole_sphere(candidate) && candidate.type != QuadricType::disk)
    shape.clip = candidate.clip;
  const bool sector = !is_whole_turn(candidate);
  if (!candidate.inward && !sector) return shape;
  if (!rectangle) shape.box = box_around(candidate);
  shape.matrix = candidate.inward ? negated(unit_matrix(candidate.type)) : unit_matrix(candidate.type);
  shape.type = QuadricType::general;
  shape.clip = {};
  return shape;
}

}  // namespace rayengine::surfaces
