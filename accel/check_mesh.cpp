#include "accel/check_mesh.h"

#include <cmath>
#include <string>

#include "accel/tracer.h"

namespace rayengine {
namespace {

bool is_finite(const glm::dvec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

}  // namespace

void check_mesh(const Mesh& mesh) {
  if (!mesh.normals.empty() && mesh.normals.size() != mesh.positions.size())
    throw Error("a mesh has " + std::to_string(mesh.normals.size()) + " normals for " +
                std::to_string(mesh.positions.size()) + " vertices: give one each, or none");
  for (std::size_t i = 0; i < mesh.positions.size(); ++i)
    if (!is_finite(mesh.positions[i])) throw Error("vertex " + std::to_string(i) + " of a mesh is not finite");
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    for (int k = 0; k < 3; ++k)
      if (mesh.triangles[i][k] >= mesh.positions.size())
        throw Error("triangle " + std::to_string(i) + " of a mesh names vertex " +
                    std::to_string(mesh.triangles[i][k]) + ", but there are " + std::to_string(mesh.positions.size()));
}

void check_tolerance(double tolerance) {
  if (!(tolerance > 0 && std::isfinite(tolerance)))
    throw Error("a tolerance of " + std::to_string(tolerance) + " cannot be kept: give a finite number above 0");
}

void check_mesh(const Mesh& mesh, double tolerance) {
  check_tolerance(tolerance);
  check_mesh(mesh);
}

}  // namespace rayengine
