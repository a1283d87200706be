#include "engine/load/mesh_cache.h"

#include <algorithm>

#include "engine/load/mesh_files.h"

namespace rayengine {
namespace {

/// Followed by positions, normals and triangles. No triangles: the mesh itself.
struct Header {
  std::uint64_t positions = 0, normals = 0, triangles = 0;
  double distance = 0;
};

struct Way {
  char format[8] = {'R', 'a', 'y', 'L', 'o', 'D', '0', '2'};
  double tolerance;
  std::uint64_t most_decimated;
};

std::filesystem::path file_of(const Mesh& mesh, double tolerance, std::size_t most_decimated) {
  const Way way{.tolerance = tolerance, .most_decimated = most_decimated};
  return mesh_file(mesh, bytes_of(way), ".mesh");
}

std::optional<CoarserMesh> find(const std::filesystem::path& file, const Mesh& original) {
  const auto content = read_mesh_file(file);
  if (!content) return {};
  MeshFileReader reader(*content);
  Header header;
  CoarserMesh found;
  if (!reader.read(header) || !reader.read(found.mesh.positions, header.positions) ||
      !reader.read(found.mesh.normals, header.normals) || !reader.read(found.mesh.triangles, header.triangles) ||
      !reader.at_end())
    return {};
  for (const glm::uvec3& t : found.mesh.triangles)
    if (std::max({t.x, t.y, t.z}) >= header.positions) return {};
  found.distance = header.distance;
  if (found.mesh.triangles.empty()) found.mesh = original;
  return found;
}

void keep(const std::filesystem::path& file, const CoarserMesh& simplified, bool is_the_original) {
  const Mesh none;
  const Mesh& mesh = is_the_original ? none : simplified.mesh;
  const Header header{mesh.positions.size(), mesh.normals.size(), mesh.triangles.size(), simplified.distance};
  write_mesh_file(file, {bytes_of(header), bytes_of(mesh.positions), bytes_of(mesh.normals), bytes_of(mesh.triangles)});
}

}  // namespace

std::optional<CoarserMesh> find_simplified(const Mesh& mesh, double tolerance, std::size_t most_decimated) {
  return find(file_of(mesh, tolerance, most_decimated), mesh);
}

CoarserMesh simplify_cached(const Mesh& mesh, double tolerance, std::size_t most_decimated) {
  const std::filesystem::path file = file_of(mesh, tolerance, most_decimated);
  if (auto found = find(file, mesh)) return *std::move(found);
  CoarserMesh result = simplify(mesh, tolerance, most_decimated);
  keep(file, result, result.mesh.triangles.size() == mesh.triangles.size());
  return result;
}

}  // namespace rayengine
