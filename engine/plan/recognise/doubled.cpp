#include "engine/plan/recognise/doubled.h"

#include <map>

#include "engine/plan/recognise/candidate.h"
#include "engine/plan/recognise/near_points.h"

namespace rayengine::surfaces {
namespace {

/// Shells further apart than this share of their size are not two of one thing.
constexpr double share = 1. / 16;

double largest(const glm::dvec3& v) { return std::max({v.x, v.y, v.z}); }

/// Ellipsoids whose sizes have the same power of two, so that how near is near is about the same for all of them.
class SizeClass {
 public:
  void add(std::uint32_t index, const glm::dvec3& center) { indices_.push_back(index), centers_.push_back(center); }
  void finish(double distance) { near_.emplace(centers_, distance); }
  template <class Visit>
  void each_near(const glm::dvec3& p, Visit visit) const {
    near_->each(p, [&](std::uint32_t i) { visit(indices_[i]); });
  }

 private:
  std::vector<std::uint32_t> indices_;
  std::vector<glm::dvec3> centers_;
  std::optional<NearPoints> near_;
};

}  // namespace

std::vector<bool> doubled(std::span<const Affine> ellipsoids, double distance) {
  std::map<int, SizeClass> classes;
  const auto class_of = [](const Affine& map) { return std::ilogb(largest(lengths(map))); };
  for (std::uint32_t i = 0; i < ellipsoids.size(); ++i) classes[class_of(ellipsoids[i])].add(i, ellipsoids[i].origin);
  for (auto& [exponent, members] : classes) members.finish(std::min(distance, share * std::ldexp(1., exponent + 2)));
  std::vector<bool> result(ellipsoids.size());
  for (std::uint32_t i = 0; i < ellipsoids.size(); ++i) {
    const Affine& map = ellipsoids[i];
    const glm::dvec3 size = lengths(map);
    const double near = std::min(distance, share * largest(size));
    const auto compare = [&](std::uint32_t k) {
      const glm::dvec3 apart =
          glm::max(glm::abs(map.origin - ellipsoids[k].origin), glm::abs(size - lengths(ellipsoids[k])));
      if (k != i && largest(apart) <= near) result[i] = result[k] = true;
    };
    for (const int step : {-1, 0, 1})
      if (const auto found = classes.find(class_of(map) + step); found != classes.end())
        found->second.each_near(map.origin, compare);
  }
  return result;
}

}  // namespace rayengine::surfaces
