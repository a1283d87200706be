#include "engine/plan/recognise/caps.h"

#include <algorithm>

#include "engine/plan/recognise/near_points.h"
#include "engine/plan/recognise/profile.h"

namespace rayengine::surfaces {
namespace {

struct Cap {
  glm::dvec3 center, normal;  // of unit length, out of the solid
  double radius;
  double oval;  // how much less its other radius is, or more
};

Cap disk(const Found& f) {
  const Affine& map = f.candidate.to_world;
  return {map.origin, map.linear[2] / glm::length(map.linear[2]), glm::length(map.linear[0]), 0};
}

/// Bound on the distance between two disks: shift, turn and swell one into the other.
double distance(const Cap& a, const Cap& b) {
  return glm::length(a.center - b.center) + 2 * a.radius * glm::length(a.normal - b.normal) +
         std::abs(a.radius - b.radius) + a.oval + b.oval;
}

bool may_have_caps(const Candidate& c) {
  return c.type >= QuadricType::cylinder && c.type <= QuadricType::hyperboloid2 && !c.inward && is_whole_turn(c);
}

std::vector<Cap> caps_of(const Candidate& c) {
  const glm::dvec3 axis = c.to_world.linear[2] / glm::length(c.to_world.linear[2]);
  const glm::dvec3 size = lengths(c.to_world);
  std::vector<Cap> caps;
  for (const int end : {0, 1}) {
    const double radius = section_radius(c.type, c.clip[end]);
    if (radius > 0)
      caps.push_back({c.to_world.point({0, 0, c.clip[end]}), end ? axis : -axis, size.x * radius,
                      std::abs(size.x - size.y) * radius});
  }
  return caps;
}

class Closing {
 public:
  Closing(std::vector<Found>& found, double tolerance) : found_(found), tolerance_(tolerance) {
    for (std::uint32_t i = 0; i < found.size(); ++i)
      if (found[i].candidate.type == QuadricType::disk) near_.add(i, disk(found[i]).center, disk(found[i]).radius);
    near_.sort();
  }

  void run() {
    for (Found& f : found_)
      if (may_have_caps(f.candidate)) close(f);
    std::erase_if(found_, [](const Found& f) { return f.triangles.empty(); });
  }

 private:
  /// The unused disk that is a cap within the tolerance, or null.
  Found* find(const Cap& cap) const {
    Found* best = nullptr;
    near_.each(cap.center, cap.radius, [&](std::uint32_t i) {
      Found& f = found_[i];
      if (f.triangles.empty() || !(error(f, cap) <= tolerance_)) return;
      if (!best || error(f, cap) < error(*best, cap)) best = &f;
    });
    return best;
  }
  static double error(const Found& f, const Cap& cap) { return f.residual + distance(disk(f), cap); }

  void close(Found& f) const {
    const std::vector<Cap> caps = caps_of(f.candidate);
    std::vector<Found*> ends;
    for (const Cap& cap : caps)
      if (Found* end = find(cap)) ends.push_back(end);
    if (caps.empty() || ends.size() != caps.size() || (ends.size() == 2 && ends[0] == ends[1])) return;
    for (std::size_t i = 0; i < ends.size(); ++i) {
      f.residual = std::max(f.residual, error(*ends[i], caps[i]));
      f.triangles.insert(f.triangles.end(), ends[i]->triangles.begin(), ends[i]->triangles.end());
      ends[i]->triangles.clear();
    }
    std::ranges::sort(f.triangles);
    f.candidate.capped = true;
  }

  std::vector<Found>& found_;
  double tolerance_;
  NearPoints near_;  // disks
};

}  // namespace

void close_with_caps(std::vector<Found>& found, double tolerance) { Closing(found, tolerance).run(); }

}  // namespace rayengine::surfaces
