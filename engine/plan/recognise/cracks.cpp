#include "engine/plan/recognise/cracks.h"

#include <algorithm>

#include "engine/plan/recognise/profile.h"

namespace rayengine::surfaces {
namespace {

constexpr double narrow = 1e-4;     // of the tolerance: cracks that rounded vertices make
constexpr double in_plane = 0.999;  // cosine

/// The point of a quadric's rim, or of its surface, that stands for a point of an edge; object space.
glm::dvec3 on_rim(const Candidate& c, const glm::dvec3& p) {
  if (c.type == QuadricType::plane) return p;
  if (c.type == QuadricType::saddle) return {p.x, p.y, p.x * p.x - p.y * p.y};
  const double radius = std::hypot(p.x, p.y);
  const double scale = radius > 0 ? section_radius(c.type, p.z) / radius : 1;
  return {scale * p.x, scale * p.y, p.z};
}

class Rims {
 public:
  Rims(const Topology& mesh, std::vector<Found>& found, double tolerance)
      : mesh_(mesh), found_(found), narrow_(narrow * tolerance), owner_(mesh.triangles.size(), no_id) {
    for (std::uint32_t i = 0; i < found.size(); ++i) {
      for (const std::uint32_t t : found[i].triangles) owner_[t] = i;
      to_object_.push_back(inverse(found[i].candidate.to_world));
    }
  }

  std::vector<std::uint32_t> run() {
    std::vector<std::uint32_t> given_back;
    for (bool changed = true; changed;) {
      changed = false;
      for (std::uint32_t i = 0; i < found_.size(); ++i) {
        if (!cracked(i)) continue;
        for (const std::uint32_t t : found_[i].triangles) owner_[t] = no_id, given_back.push_back(t);
        found_[i].triangles.clear();
        changed = true;
      }
    }
    std::erase_if(found_, [](const Found& f) { return f.triangles.empty(); });
    return given_back;
  }

 private:
  bool cracked(std::uint32_t i) const {
    // A plate that reaches beyond its edges leaves nothing open.
    if (found_[i].candidate.type == QuadricType::disk || found_[i].candidate.type == QuadricType::plane) return false;
    return std::ranges::any_of(found_[i].triangles, [&](std::uint32_t t) {
      return cracked(i, 3 * t) || cracked(i, 3 * t + 1) || cracked(i, 3 * t + 2);
    });
  }

  bool cracked(std::uint32_t i, std::uint32_t half_edge) const {
    const std::uint32_t twin = mesh_.twins[half_edge];
    if (twin == no_id || owner_[twin / 3] == i) return false;
    const glm::dvec3 a = mesh_.positions[mesh_.from(half_edge)], b = mesh_.positions[mesh_.to(half_edge)];
    const glm::dvec3 middle = 0.5 * (a + b), bulge = rim(i, middle) - middle;
    const double width = glm::length(bulge);
    if (width <= narrow_) return false;
    const std::uint32_t beside = owner_[twin / 3];
    if (beside != no_id && glm::length(rim(beside, middle) - middle - bulge) <= narrow_) return false;
    return !covers(twin, bulge / width, middle, b - a);
  }

  glm::dvec3 rim(std::uint32_t i, const glm::dvec3& p) const {
    return found_[i].candidate.to_world.point(on_rim(found_[i].candidate, to_object_[i].point(p)));
  }

  /// Whether what lies beyond an edge lies under where the rim bulges to. Of quadrics that holds for plates alone.
  bool covers(std::uint32_t half_edge, const glm::dvec3& bulge, const glm::dvec3& middle,
              const glm::dvec3& edge) const {
    const std::uint32_t owner = owner_[half_edge / 3];
    if (owner != no_id && found_[owner].candidate.type != QuadricType::plane) return false;
    const glm::dvec3 apex = mesh_.positions[mesh_.triangles[half_edge / 3][(half_edge % 3 + 2) % 3]] - middle;
    const glm::dvec3 inside = apex - glm::dot(apex, edge) / glm::dot(edge, edge) * edge;
    return glm::dot(inside, bulge) >= in_plane * glm::length(inside);
  }

  const Topology& mesh_;
  std::vector<Found>& found_;
  double narrow_;
  std::vector<std::uint32_t> owner_;  // of each triangle: what was found and has it, or no_id
  std::vector<WorldToObject> to_object_;
};

}  // namespace

std::vector<std::uint32_t> take_back_cracked(const Topology& mesh, std::vector<Found>& found, double tolerance) {
  return Rims(mesh, found, tolerance).run();
}

}  // namespace rayengine::surfaces
