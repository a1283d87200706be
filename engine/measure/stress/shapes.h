#pragma once

#include <memory>
#include <span>
#include <string>

#include "accel/geometry.h"

// What the suite's rays are sent at.
namespace rayengine::stability {

/// A quadric of about unit size.
struct Body {
  std::string name;
  QuadricShape shape;
  glm::dvec3 center{0};
  double radius = 1;  ///< of a sphere about it
};

/// One of every type, with and without caps, and a tilted ellipsoid cut by a box.
std::span<const Body> bodies();

std::shared_ptr<const Geometry> alone(const QuadricShape& shape, const Affine& to_world = {});
std::shared_ptr<const Geometry> alone(const Mesh& mesh, const Affine& to_world = {});

QuadricShape clipped(QuadricType type, double low, double high, bool capped = false);
QuadricShape of_form(const QuadricMatrix& matrix, const Box& box = {glm::dvec3(-infinity), glm::dvec3(infinity)});

/// A sphere of `radius`, closed, vertices shared: 2 * slices * (stacks - 1) triangles.
Mesh uv_sphere(unsigned stacks, unsigned slices, double radius = 1);
/// Triangles about one vertex at the world's origin, in the plane z = 0: a closed disc.
Mesh fan(unsigned triangles);
/// Two pyramids on a common base in z = 0: closed. Thin ones are made of needles or of slivers.
Mesh bipyramid(unsigned sides, double radius, double height);
Mesh cube();  ///< [-1, 1]^3, closed, vertices shared
/// (0,0,0), (size,0,0), (0,size,0)
Mesh corner_triangle(double size);

/// `mesh` with every vertex mapped.
Mesh mapped(Mesh mesh, const Affine& map);

/// Turned about an axis without symmetry, another for every i.
Affine turned(int i);

/// All bodies and a closed mesh, strewn, turned and stretched.
std::shared_ptr<const Geometry> mixture(const Affine& to_world = {});

}  // namespace rayengine::stability
