#include "engine/render/photon_map.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

namespace rayengine {
namespace {

constexpr float least_cosine = 0.5f;

std::uint8_t widest_axis(std::span<const Photon> photons) {
  glm::vec3 lower = photons.front().position, upper = lower;
  for (const Photon& p : photons) lower = glm::min(lower, p.position), upper = glm::max(upper, p.position);
  const glm::vec3 size = upper - lower;
  return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
}

}  // namespace

PhotonMap::PhotonMap(std::vector<Photon> photons, const glm::dvec3& center, std::size_t nearest, double reach)
    : photons_(std::move(photons)), axes_(photons_.size()), center_(center), nearest_(nearest), reach_(reach) {
  order(0, photons_.size());
}

void PhotonMap::order(std::size_t first, std::size_t last) {
  if (last - first < 2) return;
  const std::size_t middle = first + (last - first) / 2;
  const std::uint8_t axis = widest_axis(std::span(photons_).subspan(first, last - first));
  const auto at = [&](std::size_t i) { return photons_.begin() + static_cast<std::ptrdiff_t>(i); };
  std::nth_element(at(first), at(middle), at(last),
                   [axis](const Photon& a, const Photon& b) { return a.position[axis] < b.position[axis]; });
  axes_[middle] = axis;
  order(first, middle);
  order(middle + 1, last);
}

/// Keeps the nearest in a heap, the farthest of them on top.
void PhotonMap::consider(Search& search, std::size_t photon) const {
  const glm::vec3 way = photons_[photon].position - search.position;
  const float square = glm::dot(way, way);
  if (!(square < search.square) || glm::dot(photons_[photon].normal, search.normal) < least_cosine) return;
  if (search.found.size() == nearest_) {
    std::pop_heap(search.found.begin(), search.found.end());
    search.found.pop_back();
  }
  search.found.push_back({square, static_cast<std::uint32_t>(photon)});
  std::push_heap(search.found.begin(), search.found.end());
  if (search.found.size() == nearest_) search.square = search.found.front().square;
}

void PhotonMap::look(Search& search, std::size_t first, std::size_t last) const {
  if (first == last) return;
  const std::size_t middle = first + (last - first) / 2;
  const std::uint8_t axis = axes_[middle];
  const float side = search.position[axis] - photons_[middle].position[axis];
  side < 0 ? look(search, first, middle) : look(search, middle + 1, last);
  consider(search, middle);
  if (side * side >= search.square) return;
  side < 0 ? look(search, middle + 1, last) : look(search, first, middle);
}

glm::vec3 PhotonMap::irradiance(const glm::dvec3& position, const glm::dvec3& normal) const {
  Search search{glm::vec3(position - center_), glm::vec3(normal), static_cast<float>(reach_ * reach_)};
  search.found.reserve(nearest_);
  look(search, 0, photons_.size());
  // The farthest of as many as wanted only says how large the disc is: with it, estimates would be too high.
  const bool full = search.found.size() == nearest_;
  glm::vec3 power(0);
  for (const Found& f : std::span(search.found).subspan(full)) power += photons_[f.photon].power;
  return power / (std::numbers::pi_v<float> * search.square);
}

}  // namespace rayengine
