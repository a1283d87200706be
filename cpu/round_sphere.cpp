#include "cpu/round_sphere.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <map>

namespace rayengine {
namespace {

constexpr int subdivisions = 3;

/// Halves edges, each once for both of its triangles.
class Subdivider {
 public:
  explicit Subdivider(SphereMesh& mesh) : mesh_(mesh) {}

  std::uint32_t midpoint(std::uint32_t a, std::uint32_t b) {
    const auto [at, added] = middle_.try_emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh_.positions.size()));
    if (added) mesh_.positions.push_back(glm::normalize(mesh_.positions[a] + mesh_.positions[b]));
    return at->second;
  }

  std::vector<glm::uvec3> quarter(const glm::uvec3& t) {
    const glm::uvec3 m(midpoint(t.x, t.y), midpoint(t.y, t.z), midpoint(t.z, t.x));
    return {{t.x, m.x, m.z}, {m.x, t.y, m.y}, {m.z, m.y, t.z}, {m.x, m.y, m.z}};
  }

 private:
  SphereMesh& mesh_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middle_;
};

}  // namespace

std::optional<RoundSphere> round_sphere(const Quadric& quadric) {
  if (quadric.type != QuadricType::sphere || std::isfinite(quadric.zmin) || std::isfinite(quadric.zmax)) return {};
  const glm::dmat3 m = glm::transpose(quadric.to_object.linear) * quadric.to_object.linear;
  const double scale = m[0][0], slack = 1e-9 * scale;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      if (!(std::abs(m[i][j] - (i == j ? scale : 0)) <= slack)) return {};
  return RoundSphere{quadric.to_object.origin, 1 / std::sqrt(scale)};
}

SphereMesh unit_sphere_mesh() {
  SphereMesh mesh;
  mesh.positions = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int level = 0; level < subdivisions; ++level) {
    Subdivider subdivider(mesh);
    std::vector<glm::uvec3> finer;
    for (const glm::uvec3& triangle : mesh.triangles)
      for (const glm::uvec3& part : subdivider.quarter(triangle)) finer.push_back(part);
    mesh.triangles = std::move(finer);
  }
  return mesh;
}

}  // namespace rayengine
