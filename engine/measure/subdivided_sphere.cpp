#include <glm/geometric.hpp>
#include <map>

#include "engine/measure/tessellate.h"

namespace rayengine {
namespace {

/// Halves edges, each once for both of its triangles.
class Subdivider {
 public:
  explicit Subdivider(Mesh& mesh) : mesh_(mesh) {}

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
  Mesh& mesh_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middle_;
};

}  // namespace

Mesh subdivided_sphere(int subdivisions) {
  Mesh mesh;
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
