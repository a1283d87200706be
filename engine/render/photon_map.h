#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace rayengine {

/// Light that arrived on a surface by way of glass and mirrors.
struct Photon {
  glm::vec3 position{0};  ///< from the map's centre
  glm::vec3 power{0};     ///< linear RGB times area
  glm::vec3 normal{0};    ///< of the surface, on the side that the light came from
};

/// Photons where they came to rest, to be asked how much light falls on a surface. Source: Jensen, "Global Illumination
/// using Photon Maps" (1996): a balanced k-d tree, and the power of the nearest photons over the disc that holds them.
class PhotonMap {
 public:
  /// Of photons about `center`. Estimates take up to `nearest` of them, and none farther than `reach`.
  PhotonMap(std::vector<Photon> photons, const glm::dvec3& center, std::size_t nearest, double reach);

  /// Light that falls on a surface at `position` from the side that `normal` (of unit length) points to, a unit area:
  /// comparable with a light's colour times N.L. Photons on surfaces turned away by more than 60 degrees do not count.
  /// Safe to call from several threads.
  glm::vec3 irradiance(const glm::dvec3& position, const glm::dvec3& normal) const;

  std::size_t size() const { return photons_.size(); }

 private:
  struct Found {
    float square;  ///< of the distance
    std::uint32_t photon;
    bool operator<(const Found& b) const { return square < b.square; }
  };
  struct Search {
    glm::vec3 position, normal;
    float square;  ///< of how far it is still worth looking
    std::vector<Found> found{};
  };

  void order(std::size_t first, std::size_t last);
  void look(Search& search, std::size_t first, std::size_t last) const;
  void consider(Search& search, std::size_t photon) const;

  std::vector<Photon> photons_;  ///< as a tree: the middle of each range splits it
  std::vector<std::uint8_t> axes_;
  glm::dvec3 center_;
  std::size_t nearest_;
  double reach_;
};

}  // namespace rayengine
