#include "engine/load/json_transform.h"

namespace rayengine {
namespace {

Affine matrix(const JsonView& value) {
  const auto m = value.numbers<16>();
  if (m[12] != 0 || m[13] != 0 || m[14] != 0 || m[15] != 1)
    fail(value.place(), "the last row of a transform is not 0, 0, 0, 1; only affine maps are taken, row by row");
  Affine map;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) map.linear[column][row] = m[4 * row + column];
    map.origin[row] = m[4 * row + 3];
  }
  return map;
}

Affine scale(const JsonView& value) {
  return Affine::scale(value.is_number() ? glm::dvec3(value.number()) : value.vector());
}

Affine rotate(const JsonView& value) {
  JsonFields fields(value);
  const glm::dvec3 axis = fields.need("axis").vector();
  const double degrees = fields.need("degrees").number();
  fields.finish();
  return at_place(value.place(), [&] { return Affine::rotate(axis, degrees); });
}

Affine step(const JsonView& value) {
  JsonFields fields(value);
  const auto by = fields.find("scale"), about = fields.find("rotate"), to = fields.find("translate");
  fields.finish();
  if (by.has_value() + about.has_value() + to.has_value() != 1)
    fail(value.place(), "a step of a transform is not one of scale, rotate and translate; give each its own braces");
  return by ? scale(*by) : about ? rotate(*about) : Affine::translate(to->vector());
}

}  // namespace

Affine read_transform(const JsonView& value) {
  const std::vector<JsonView> steps = value.list();
  if (!steps.empty() && steps[0].is_number()) return matrix(value);
  Affine map;
  for (const JsonView& s : steps) map = step(s) * map;
  return map;
}

}  // namespace rayengine
