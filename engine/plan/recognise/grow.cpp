#include "engine/plan/recognise/grow.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "engine/plan/recognise/neighbourhood.h"
#include "engine/plan/recognise/recognise.h"
#include "engine/plan/recognise/tube.h"

namespace rayengine::surfaces {
namespace {

/// Triangles that a growth begins with: three facets, whose four lines along a cylinder tell it from other surfaces.
constexpr std::size_t seed_size = 6;

/// One triangle in so many is tried: most of what grows has many, next to each other in the mesh's order.
constexpr std::size_t seed_stride = 4;

/// Corners are this near to a cylinder, in units of its radius: what files in print leave of their digits.
constexpr double snug = 1e-5;

/// A cylinder with a radius of more than so many times a seed's size is as good as flat.
constexpr double flattest = 30;

class Growth {
 public:
  Growth(const Topology& mesh, std::span<const std::uint32_t> waiting)
      : mesh_(mesh), waiting_(waiting), region_of_(mesh.triangles.size(), no_id), seen_(mesh.triangles.size(), 0) {
    for (const std::uint32_t t : waiting) region_of_[t] = free;
  }

  Regions run() {
    std::uint32_t count = 0;
    for (const std::uint32_t seed : good_seeds()) {
      if (region_of_[seed] != free) continue;
      const std::vector<std::uint32_t> patch = grown(seed);
      if (patch.size() < fewest_triangles) continue;
      for (const std::uint32_t t : patch) region_of_[t] = count;
      ++count;
    }
    std::ranges::replace(region_of_, free, no_id);
    return Regions(std::move(region_of_), count);
  }

 private:
  static constexpr std::uint32_t free = no_id - 1;

  /// In the mesh's space.
  struct Cylinder {
    glm::dvec3 base, axis;
    double radius, noise;

    double off(const glm::dvec3& p) const { return std::abs(glm::length(glm::cross(p - base, axis)) - radius); }
    /// Where there is nothing at right angles, nor any triangle without a normal.
    bool runs_along(const glm::dvec3& normal) const { return std::abs(glm::dot(normal, axis)) < 0.1; }
  };

  std::optional<Cylinder> fit(std::span<const std::uint32_t> triangles) const {
    const Patch patch{mesh_, triangles};
    const Cloud cloud(patch);
    const auto fitted = cloud.usable() ? fit_cylinder(patch, cloud) : std::nullopt;
    if (!fitted || fitted->tube.radius > flattest || fitted->noise > snug * fitted->tube.radius) return {};
    return Cylinder{cloud.world(fitted->tube.base), fitted->tube.axis, cloud.extent * fitted->tube.radius,
                    cloud.extent * fitted->noise};
  }

  std::vector<std::uint32_t> seed_patch(std::uint32_t seed) const {
    return neighbourhood(mesh_, seed, seed_size, [&](std::uint32_t t) { return region_of_[t] == free; });
  }

  std::vector<std::uint32_t> good_seeds() const {
    std::vector<char> good(waiting_.size() / seed_stride, 0);
    tbb::parallel_for(std::size_t{0}, good.size(), [&](std::size_t i) {
      const auto patch = seed_patch(waiting_[i * seed_stride]);
      good[i] = patch.size() >= seed_size && fit(patch);
    });
    std::vector<std::uint32_t> seeds;
    for (std::size_t i = 0; i < good.size(); ++i)
      if (good[i]) seeds.push_back(waiting_[i * seed_stride]);
    return seeds;
  }

  /// All that is on the seed's cylinder and connected to it, with the cylinder fitted again as it grows; ascending.
  std::vector<std::uint32_t> grown(std::uint32_t seed) {
    std::vector<std::uint32_t> patch = seed_patch(seed);
    for (int round = 0; round < 4; ++round) {
      const std::optional<Cylinder> cylinder = fit(patch);
      if (!cylinder) break;  // no cylinder after all, which need not be found out again from each of its triangles
      std::vector<std::uint32_t> more = on(*cylinder, seed);
      if (more.size() <= patch.size() && round > 0) break;
      patch = std::move(more);
    }
    std::ranges::sort(patch);
    return patch;
  }

  std::vector<std::uint32_t> on(const Cylinder& cylinder, std::uint32_t seed) {
    const double allowance = std::max(3 * cylinder.noise, snug * cylinder.radius);
    std::vector<std::uint32_t> patch{seed};
    ++stamp_;
    seen_[seed] = stamp_;
    for (std::size_t i = 0; i < patch.size(); ++i)
      each_smooth_neighbour(mesh_, patch[i], [&](std::uint32_t t) {
        if (region_of_[t] != free || seen_[t] == stamp_ || !cylinder.runs_along(mesh_.normals[t])) return;
        for (int k = 0; k < 3; ++k)
          if (!(cylinder.off(mesh_.positions[mesh_.triangles[t][k]]) <= allowance)) return;
        seen_[t] = stamp_;
        patch.push_back(t);
      });
    return patch;
  }

  const Topology& mesh_;
  std::span<const std::uint32_t> waiting_;
  std::vector<std::uint32_t> region_of_;
  std::vector<std::uint32_t> seen_;  // by which round
  std::uint32_t stamp_ = 0;
};

}  // namespace

Regions grow_cylinders(const Topology& mesh, std::span<const std::uint32_t> waiting) {
  return Growth(mesh, waiting).run();
}

}  // namespace rayengine::surfaces
