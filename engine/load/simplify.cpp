#include "engine/load/simplify.h"

#include <algorithm>

#include "accel/check_mesh.h"
#include "engine/load/cluster.h"
#include "engine/load/decimate.h"
#include "engine/load/surface_distance.h"

namespace rayengine {
namespace {

constexpr double clusters_share = 0.75;  // of the tolerance; the decimater has the rest

/// Positions from the mesh's own centre in units of the tolerance: as exact far off as near, and what OpenMesh takes
/// for a triangle without area does not depend on units.
std::vector<glm::dvec3> in_tolerances(const Mesh& mesh, double tolerance) {
  Box box;
  for (const glm::dvec3& p : mesh.positions) box.add(p);
  std::vector<glm::dvec3> local;
  local.reserve(mesh.positions.size());
  for (const glm::dvec3& p : mesh.positions) local.push_back((p - box.center()) / tolerance);
  return local;
}

/// What the roundings of those positions, and of distances between them, may amount to.
double roundings(const std::vector<glm::dvec3>& local) {
  Box box;
  for (const glm::dvec3& p : local) box.add(p);
  return 1e-9 + 32 * 0x1p-53 * box.extent();
}

std::vector<glm::uvec3> with_area(const std::vector<glm::dvec3>& positions, std::vector<glm::uvec3> triangles) {
  std::erase_if(triangles, [&](const glm::uvec3& t) { return area_vector(corners(positions, t)) == glm::dvec3(0); });
  return triangles;
}

/// Those vertices that are used, in their old order.
Mesh with_used_vertices(const Mesh& mesh, std::vector<glm::uvec3> triangles) {
  std::vector<std::uint32_t> number(mesh.positions.size(), no_id);
  for (const glm::uvec3& t : triangles)
    for (int k = 0; k < 3; ++k) number[t[k]] = 0;
  Mesh result;
  for (std::size_t i = 0; i < number.size(); ++i) {
    if (number[i] == no_id) continue;
    number[i] = static_cast<std::uint32_t>(result.positions.size());
    result.positions.push_back(mesh.positions[i]);
    if (!mesh.normals.empty()) result.normals.push_back(mesh.normals[i]);
  }
  for (glm::uvec3& t : triangles) t = {number[t.x], number[t.y], number[t.z]};
  result.triangles = std::move(triangles);
  return result;
}

}  // namespace

CoarserMesh simplify(const Mesh& mesh, double tolerance, std::size_t most_decimated) {
  check_mesh(mesh, tolerance);
  const std::vector<glm::dvec3> local = in_tolerances(mesh, tolerance);
  const double whole = 1 - roundings(local);
  const std::vector<glm::uvec3> triangles = with_area(local, mesh.triangles);
  if (triangles.empty() || !(whole > 0.5)) return {mesh, 0};
  Coarser coarse{cluster(local, triangles, clusters_share * whole), 0};
  if (coarse.triangles.size() < triangles.size()) coarse.distance = clusters_share * whole;
  if (coarse.triangles.size() <= most_decimated) {
    const double clustered = coarse.distance;
    coarse = decimate(local, coarse.triangles, whole - clustered);
    coarse.distance += clustered;
  }
  if (coarse.triangles.size() == mesh.triangles.size()) return {mesh, 0};
  return {with_used_vertices(mesh, std::move(coarse.triangles)), (coarse.distance + 1 - whole) * tolerance};
}

}  // namespace rayengine
